#include "apps/walk/clean_view.h"

#include <optional>
#include <utility>

#include "parallel/walk/live_walk.h"

namespace lightwalk {

bool CleanView::follow(const LivePicture& picture, const DisplayRequest& display, bool rests) {
    if (failed_) return false;
    if (!cleaner_.problem().empty()) {
        failed_ = true;
        (void)drop();
        return true;
    }
    const bool whole = picture.phase == WalkPhase::refining || picture.phase == WalkPhase::done;
    if (!rests || !whole || !display.clean || display.settings.false_colour) return drop();
    std::optional<std::vector<Rgb>> made = cleaner_.take();
    const bool came = made.has_value();
    if (came) radiance_ = *std::move(made);
    if (!cleaner_.is_busy() && begun_ != picture.phase) {
        begun_ = picture.phase;
        cleaner_.begin({picture.width, picture.height, picture.radiance});
    }
    return came;
}

/// Whether there was anything.
bool CleanView::drop() {
    cleaner_.give_up();
    begun_ = WalkPhase::moving;
    return !std::exchange(radiance_, {}).empty();
}

std::string CleanView::take_problem() {
    if (!failed_ || std::exchange(told_, true)) return {};
    return "pictures are not denoised any more: " + cleaner_.problem();
}

}  // namespace lightwalk
