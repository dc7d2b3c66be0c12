#include "apps/walk_pictures.h"

#include "apps/interrupt.h"

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
    if (!meter_) begin_progress(options);
    WalkFrame drawn;
    if (prepare(*request, anew))
        drawn = frames_->draw(request->camera.view(), options_.budget, options_.refine,
                              interrupt_flag());
    statistics_.rays += drawn.frame.rays;
    statistics_.ambient += drawn.frame.ambient;
    if (drawn.frame.complete) {
        statistics_.walk.add(std::move(drawn.report));
        ++frames_done_;
        meter_->update(0, {static_cast<double>(frames_done_) / static_cast<double>(frames_wanted_),
                           statistics_.rays.total(), statistics_.ambient.computed});
    }
    if (!drawn.frame.complete || frames_done_ == frames_wanted_) end_progress(drawn.frame.complete);
    if (!drawn.frame.complete) return std::nullopt;
    return std::move(drawn.frame);
}

void WalkPictures::begin_progress(const FrameOptions& options) {
    WorkPhase all;
    all.pixels = static_cast<double>(options.whole().pixels() * frames_wanted_);
    all.workers = workers_;
    meter_.emplace(progress_, std::vector{all});
    warnings_.use_terminal_line(progress_.bar);
}

void WalkPictures::end_progress(bool complete) {
    meter_->finish(complete, statistics_.rays.total());
    meter_.reset();
    warnings_.use_terminal_line(false);
}

}  // namespace lightwalk
