#include "parallel/walk/views_around.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/vec3.h"
#include "core/view/view_path.h"

namespace lightwalk {
namespace {

constexpr double kApart = 0.9;  // of the field of view: borders are seen from both sides
constexpr double kFewUnknown = 0.005;
constexpr double kMostViews = 12;  // of a narrow view those that it turns to first

/// Of all views around once.
struct Round {
    double share;         ///< see ViewAside
    double traced;        ///< of the resting picture's pixels, before it
    bool when_done;       ///< not before the resting picture is done
    double most_seconds;  ///< afterwards views that are left are left out
};
constexpr std::array<Round, 2> kRounds{{{0.25, 0.06, false, 2}, {0.5, 1, true, 6}}};

/// Above the horizon [degrees].
double elevation(const View& view) {
    const double up = dot(normalize(view.direction), normalize(view.up));
    return std::asin(std::clamp(up, -1.0, 1.0)) * (180 / kPi);
}

}  // namespace

ViewsAround::ViewsAround(const View& view) : home_(view) {
    constexpr double kCircle = 360;
    if (view.type != 'v') return;
    const double step = kApart * view.horizontal;
    const int beside = static_cast<int>(std::min(std::ceil(kCircle / step) - 1, kMostViews));
    for (int i = 1; 2 * i <= beside + 1; ++i) {
        views_.push_back(turned_view(view, i * step));
        if (2 * i <= beside) views_.push_back(turned_view(view, -i * step));
    }
}

bool ViewsAround::hold(const View& view) const {
    constexpr double kHigher = 0.25;  // of the field of view
    return !views_.empty() && view.type == home_.type && view.position == home_.position &&
           view.up == home_.up && view.horizontal <= home_.horizontal &&
           std::abs(elevation(view) - elevation(home_)) <= kHigher * home_.vertical;
}

std::optional<ViewAside> ViewsAround::next(double traced, bool done) const {
    if (views_.empty() || round_ == kRounds.size()) return std::nullopt;
    const Round& round = kRounds[round_];
    if (traced < round.traced || (round.when_done && !done)) return std::nullopt;
    return ViewAside{views_[at_], round.share};
}

void ViewsAround::record(double unknown, double seconds) {
    seconds_ += seconds;
    if (unknown < kFewUnknown) ++at_;
    if (at_ < views_.size() && seconds_ < kRounds[round_].most_seconds) return;
    ++round_;
    at_ = 0;
    seconds_ = 0;
}

}  // namespace lightwalk
