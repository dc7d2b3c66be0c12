#include "apps/session/walk_pictures.h"

#include <algorithm>
#include <vector>

namespace lightwalk {

std::optional<Frame> WalkPictures::take() {
    const std::shared_ptr<const PictureRequest> request = std::move(requests_.front());
    requests_.pop_front();
    const FrameOptions& options = request->options;
    if (!frames_) {
        FrameOptions all = options;
        all.previous = nullptr;  // walks are not blurred by motion
        frames_ = make_frames(all);
    }
    const bool anew = width_ != options.width || height_ != options.height;
    if (anew) frames_->begin(options.width, options.height, false, frames_done_);
    width_ = options.width;
    height_ = options.height;
    if (!reporter_) begin_progress(options);
    WalkFrame drawn;
    if (prepare(*request, anew))
        drawn = frames_->draw(request->camera.view(), options_.budget, options_.refine, stop_);
    statistics_.rays += drawn.frame.rays;
    statistics_.ambient += drawn.frame.ambient;
    if (drawn.frame.complete) {
        statistics_.walk.add(std::move(drawn.report));
        ++frames_done_;
        if (frames_wanted_ > 0)
            reporter_->update(
                0, {static_cast<double>(frames_done_) / static_cast<double>(frames_wanted_),
                    statistics_.rays.total(), statistics_.ambient.computed});
    }
    const bool last = frames_wanted_ == 0 || frames_done_ == frames_wanted_;
    if (!drawn.frame.complete || last) end_progress(drawn.frame.complete);
    if (!drawn.frame.complete) return std::nullopt;
    return std::move(drawn.frame);
}

void WalkPictures::begin_progress(const FrameOptions& options) {
    WorkPhase all;
    all.pixels =
        static_cast<double>(options.whole().pixels() * std::max(frames_wanted_, std::size_t{1}));
    all.workers = workers_;
    reporter_.emplace(listener_, std::vector{all});
}

void WalkPictures::end_progress(bool complete) {
    reporter_->finish(complete, statistics_.rays.total());
    reporter_.reset();
}

}  // namespace lightwalk
