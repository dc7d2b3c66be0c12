#include "core/cloud/moving_size.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwalk {
namespace {

// At the second step frames take more time, from each further one to the next there are fewer
// pixels by the square root of two.
constexpr std::array kShares{1.0,    1.0,    0.8409, 0.7071, 0.5946, 0.5,   0.4204,
                             0.3536, 0.2973, 0.25,   0.2102, 0.1768, 0.1487};
constexpr double kGrowth = 1.4142;
// The last step for pictures of any size; smaller shares are for those that they leave so many
// pixels, as fewer are of no use.
constexpr int kLastStep = 7;
constexpr double kLeastPixels = 110'000;
// Where much of these would be guessed all the same, on a busy machine, pictures may have as few as
// this: blurred, but of what is there.
constexpr double kFewestPixels = 28'000;
// Pictures of up to so many pixels take a little more time, of so many twice as much, and so on.
constexpr double kSmallPixels = 640 * 480, kLargePixels = 1280 * 720;
constexpr double kLeastPeriods = 1, kPeriodsOfLarge = 2, kMostPeriods = 2.5;
// Guessed pixels, as a share: with more of them a frame is too large, with fewer it may be too
// small. With many it is much too large.
constexpr double kMany = 0.25, kMuch = 0.06, kMost = 0.03, kFew = 0.005;
// An inferred pixel, whose edges and patterns are right, is as bad as so much of a guessed one.
constexpr double kInferred = 0.1, kFewInferred = 0.22;
// Of the budget, for all but tracing, which takes the time that is left: the next size would fit.
// Where all together takes longer than this frames are too large: they would come too seldom.
constexpr double kShort = 0.85 / kGrowth, kLate = 1.2;
constexpr int kBad = 2;  // frames in a row: one may be a matter of a busy machine
constexpr int kPatience = 8, kMostPatience = 256, kSoon = 60;  // [frames]

}  // namespace

double MovingSize::share() const {
    return kShares[static_cast<std::size_t>(step_)];
}

double MovingSize::periods(int width, int height) const {
    if (!patient_ || step_ == 0) return 1;
    const double pixels = static_cast<double>(width) * static_cast<double>(height);
    const double share = (pixels - kSmallPixels) / (kLargePixels - kSmallPixels);
    const double periods = std::lerp(kLeastPeriods, kPeriodsOfLarge, std::max(share, 0.0));
    return std::min(periods, kMostPeriods);
}

void MovingSize::set_patient(bool patient) {
    patient_ = patient;
    if (!patient) step_ = std::max(step_, 1);
}

int MovingSize::of(int side) const {
    return std::max(1, static_cast<int>(std::lround(share() * side)));
}

/// The step of the smallest share of a picture.
/// @param pixels  of its frames at the share of now
/// @param least   fewer pixels it may not have, below the share of kLastStep
int MovingSize::last_step(double pixels, double least) const {
    int last = kLastStep;
    const auto pixels_at = [&](int step) {
        const double share = kShares[static_cast<std::size_t>(step)] / this->share();
        return pixels * share * share;
    };
    while (last + 1 < static_cast<int>(kShares.size()) && pixels_at(last + 1) >= least) ++last;
    return last;
}

int MovingSize::first_step() const {
    return std::max(patient_ ? 0 : 1, limit_);
}

void MovingSize::limit(int width, int height, double most_pixels) {
    const double pixels = static_cast<double>(width) * static_cast<double>(height);
    const int last = last_step(pixels * share() * share(), kLeastPixels);
    limit_ = 0;
    const auto pixels_at = [&](int step) {
        const double share = kShares[static_cast<std::size_t>(step)];
        return pixels * share * share;
    };
    while (limit_ < last && pixels_at(limit_) > most_pixels) ++limit_;
    if (step_ < limit_) step(limit_ - step_, pixels_at(step_), kLeastPixels);
}

/// @param least  see last_step
void MovingSize::step(int by, double pixels, double least) {
    const int last = std::max(step_, last_step(pixels, least));
    const int next = std::clamp(step_ + by, std::min(first_step(), last), last);
    changed_ = next != step_;
    step_ = next;
    good_ = bad_ = 0;
}

void MovingSize::record(const CloudReport& report, double budget) {
    if (since_larger_ > 0 && ++since_larger_ > kSoon) {
        since_larger_ = 0;
        patience_ = kPatience;
    }
    if (changed_) return void(changed_ = false);
    const auto pixels = static_cast<double>(report.pixels);
    const double inferred = static_cast<double>(report.inferred) / pixels;
    const double guessed = static_cast<double>(report.filled) / pixels - inferred;
    const double wrong = guessed + kInferred * inferred;
    const double seconds =
        report.project_seconds + report.check_seconds + report.infer_seconds + report.keep_seconds;
    const bool late = seconds + report.trace_seconds > kLate * budget;
    const bool tiny = step_ > last_step(pixels, kLeastPixels);
    bad_ = wrong > (tiny ? kMuch : kMost) || late ? bad_ + 1 : 0;
    const bool fits =
        guessed < kFew && (tiny || inferred < kFewInferred) && seconds < kShort * budget;
    good_ = fits ? good_ + 1 : 0;
    if (bad_ >= kBad || wrong > kMany) {
        // A larger size that soon proved too large is tried again later and later.
        if (since_larger_ > 0) patience_ = std::min(2 * patience_, kMostPatience);
        since_larger_ = 0;
        step(wrong > kMany ? 4 : 1, pixels, wrong > kMuch ? kFewestPixels : kLeastPixels);
    } else if (good_ >= patience_ && step_ > first_step()) {
        step(seconds < kShort * kShort * budget ? -2 : -1, pixels, kLeastPixels);
        since_larger_ = 1;
    }
}

}  // namespace lightwalk
