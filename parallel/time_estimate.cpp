#include "parallel/time_estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace lightwalk {
namespace {

// Measured on pictures of two furnished rooms, with one and two bounces and spacings
// of 1 and 4; the tests replay some of them.
constexpr double kUsualExponent = 0.85;  ///< of the work of a prepass as a power of its share done
/// Weight of the prediction made before a phase begins, as a share of the phase; it decreases with
/// the share that is left.
constexpr double kTrust = 0.6;

// Prior of the rays for the direct light of a pixel; its weight is that of a report of a small
// block.
constexpr double kUsualPixelRays = 10, kUsualPixelWeight = 64 * 64;
/// Ratio of primary rays to pixels where pixels are interpolated.
constexpr double kTracedShare = 0.4;

constexpr double kFarther = 1.1;  ///< ratio of the shares of points that are kept
constexpr double kFitRange = 4;   ///< ratio of the shares between which an exponent is fitted

}  // namespace

std::vector<WorkPhase> plan_picture(const FrameOptions& options, CachePrepass prepass,
                                    int workers) {
    std::vector<WorkPhase> phases;
    if (prepass != CachePrepass::none) {
        phases.push_back({WorkPhase::Kind::prepass,
                          static_cast<double>(prepass_pixels(options, prepass)), 1,
                          static_cast<double>(workers)});
    }
    phases.push_back({WorkPhase::Kind::picture, static_cast<double>(options.area().pixels()),
                      (options.pixels.spacing > 1 ? kTracedShare : 1.0) * options.pixels.samples,
                      static_cast<double>(workers)});
    if (prepass == CachePrepass::deterministic) phases.back().late_values = 0;
    return phases;
}

TimeEstimator::TimeEstimator(std::vector<WorkPhase> phases) : phases_(std::move(phases)) {
    assert(!phases_.empty());
}

void TimeEstimator::enter(std::size_t phase, double seconds) {
    const double expected = expected_total(phases_[phase]);
    expected_ = expected > 0 ? std::optional(expected) : std::nullopt;
    phase_ = phase;
    began_ = seconds;
    elapsed_ = 0;
    now_ = {};
    points_.clear();
}

void TimeEstimator::add(std::size_t phase, double seconds, const FrameProgress& progress) {
    assert(phase >= phase_ && phase < phases_.size());
    if (phase != phase_) enter(phase, began_ + elapsed_);
    fit_block(progress);
    now_ = progress;
    elapsed_ = std::max(seconds - began_, 1e-6);
    if (points_.empty() || progress.done > kFarther * points_.back().share)
        points_.push_back({progress.done, static_cast<double>(progress.rays)});
    if (progress.done <= 0) return;
    double left = std::max(present_left(), 0.0);
    for (std::size_t i = phase_ + 1; i < phases_.size(); ++i) left += expected_total(phases_[i]);
    const double gone = began_ + elapsed_;
    estimate_.seconds_left = left;
    estimate_.done = std::max(estimate_.done, gone / (gone + left));
}

void TimeEstimator::fit_block(const FrameProgress& now) {
    if (phases_[phase_].kind != WorkPhase::Kind::prepass) return;
    const double p = (now.done - now_.done) * phases_[phase_].pixels;
    const auto v = static_cast<double>(now.ambient_values - now_.ambient_values);
    const auto r = static_cast<double>(now.rays - now_.rays);
    pp_ += p * p;
    pv_ += p * v;
    vv_ += v * v;
    pr_ += p * r;
    vr_ += v * r;
}

/// Least squares of rays = a pixels + b values over the reports, a >= 0.
double TimeEstimator::rays_a_pixel() const {
    const double pp = pp_ + kUsualPixelWeight;
    const double pr = pr_ + kUsualPixelWeight * kUsualPixelRays;
    if (vv_ <= 0) return pr / pp;
    return std::max((pr * vv_ - vr_ * pv_) / (pp * vv_ - pv_ * pv_), 0.0);
}

/// The exponent of rays as a power of the share done, between an earlier point and now; the usual
/// one while there is no earlier point.
double TimeEstimator::exponent() const {
    constexpr double kLeast = 0.3, kMost = 1;
    const auto from = std::find_if(points_.begin(), points_.end(), [&](const Point& point) {
        return point.share * kFitRange >= now_.done;
    });
    const double ratio = now_.done / from->share;
    if (ratio <= 1 || from->rays <= 0) return kUsualExponent;
    const double measured = std::log(static_cast<double>(now_.rays) / from->rays) / std::log(ratio);
    // The shorter the range, the less the measured exponent is trusted.
    const double trust = std::min(1.0, std::log(ratio) / std::log(kFitRange)) / 2;
    return std::clamp(trust * measured + (1 - trust) * kUsualExponent, kLeast, kMost);
}

/// Remaining time of the present phase [s].
double TimeEstimator::present_left() const {
    if (phases_[phase_].kind == WorkPhase::Kind::prepass)
        return elapsed_ * (std::pow(now_.done, -exponent()) - 1);
    const double trust = expected_ ? kTrust * (1 - now_.done) : 0;
    return (elapsed_ + trust * expected_.value_or(0)) / (now_.done + trust) - elapsed_;
}

/// Predicted time of a later phase, from the present one [s].
double TimeEstimator::expected_total(const WorkPhase& phase) const {
    const WorkPhase& present = phases_[phase_];
    const auto rays = static_cast<double>(now_.rays);
    if (rays <= 0) return 0;
    const double share = present.kind == WorkPhase::Kind::prepass ? exponent() : 1;
    const double all_rays = rays / std::pow(now_.done, share);
    const double pixel_rays = rays_a_pixel();
    const double value_rays = std::max(all_rays - pixel_rays * present.pixels, 0.0);
    const double expected =
        pixel_rays * phase.pixels * phase.rays + phase.late_values * phase.rays * value_rays;
    return expected * elapsed_ / rays * present.workers / phase.workers;
}

}  // namespace lightwalk
