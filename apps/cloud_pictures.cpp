#include "apps/cloud_pictures.h"

#include "apps/interrupt.h"
#include "parallel/walk/walk_frame.h"

namespace lightwalk {

std::optional<Frame> CloudPictures::take() {
    const std::shared_ptr<const PictureRequest> request = std::move(requests_.front());
    requests_.pop_front();
    const FrameOptions& options = request->options;
    const bool anew = !frames_ || width_ != options.width || height_ != options.height;
    if (anew) {
        frames_.emplace(options.width, options.height, options_, frames_done_);
        width_ = options.width;
        height_ = options.height;
    }
    if (!meter_) begin_progress(options);
    WalkFrame drawn;
    if (run_prepass(*request, anew))
        drawn = draw_walk_frame(*frames_, session_.tracer(), probe_, request->camera, options,
                                executor_, contexts_, interrupt_flag());
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

void CloudPictures::begin_progress(const FrameOptions& options) {
    WorkPhase all;
    all.pixels = static_cast<double>(options.whole().pixels() * frames_wanted_);
    all.workers = executor_.concurrency();
    meter_.emplace(progress_, std::vector{all});
    warnings_.use_terminal_line(progress_.bar);
}

void CloudPictures::end_progress(bool complete) {
    meter_->finish(complete, statistics_.rays.total());
    meter_.reset();
    warnings_.use_terminal_line(false);
}

/// The first frame fills the ambient cache for all; with --deterministic each frame does, whose
/// rays find the cache frozen. False: interrupted.
bool CloudPictures::run_prepass(const PictureRequest& request, bool first) {
    if (!session_.freezable || (!first && prepass_ != CachePrepass::deterministic)) return true;
    const CachePrepassResult played = fill_ambient_cache(
        session_.tracer(), request.camera, request.options, prepass_, *session_.freezable,
        executor_, contexts_, interrupt_flag(), [](const FrameProgress&) {});
    statistics_.rays += played.rays;
    statistics_.ambient += played.ambient;
    return played.complete;
}

}  // namespace lightwalk
