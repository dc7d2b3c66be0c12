// A walk that others go on with where its ranks are lost: what is kept for them, and found.
#include <algorithm>

#include "apps/walk/render_loop.h"

namespace lightwalk {

/// Points of another state of the scene would be of another light.
bool RenderLoop::may_be_kept() const {
    return !groups_ && !scene_state_.time && scene_state_.replaced.empty();
}

/// Before the first picture: what those before have kept is known.
void RenderLoop::recall(WalkAmbient ambient, const StopFlag& stop) {
    if (recalled_) return;
    recalled_ = true;
    if (!options_.kept || !may_be_kept()) return;
    const std::optional<KnownPicture> known = options_.kept->read();
    if (!known || known->indirect != (ambient == WalkAmbient::always)) return;
    if (!live_.recall(*known, ambient, stop)) return;
    constexpr double kMost = 0.8;  // else small pictures, and what is inferred, look better
    const auto pixels = static_cast<double>(known->values.size());
    const auto there = static_cast<double>(std::ranges::count_if(
        known->values, [](const PixelValue& value) { return value.distance > 0; }));
    if (there > kMost * pixels && known->view == *view_) small_sketches_ = sketches_ = 0;
}

/// Of a view that rests, until all of its pixels are known.
void RenderLoop::keep(Clock::time_point now) {
    constexpr std::chrono::seconds kOften{2};
    const bool whole = live_.picture().phase != WalkPhase::filling;
    if (!options_.kept || !drawn_ || live_.picture().phase == WalkPhase::moving ||
        now - kept_at_ < kOften || (kept_view_ == view_ && kept_whole_) || !may_be_kept())
        return;
    std::optional<KnownPicture> known = frames_.known();
    if (!known) return;
    options_.kept->write(*known);
    kept_at_ = now;
    kept_view_ = view_;
    kept_whole_ = whole;
}

}  // namespace lightwalk
