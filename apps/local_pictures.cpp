#include "apps/local_pictures.h"

#include "apps/interrupt.h"
#include "parallel/time_estimate.h"

namespace lightwalk {

std::optional<Frame> LocalPictures::take() {
    const std::shared_ptr<const PictureRequest> request = std::move(requests_.front());
    requests_.pop_front();
    const std::vector<WorkPhase> phases =
        plan_picture(request->options, prepass_, executor_.concurrency());
    const std::size_t picture = phases.size() - 1;
    ProgressMeter meter(progress_, phases);
    warnings_.use_terminal_line(progress_.bar);
    const RayCounters before = statistics_.rays;
    Frame frame;
    if (run_prepass(*request, meter)) {
        frame = render_frame(
            session_.tracer(), request->camera, request->options, executor_, contexts_,
            interrupt_flag(),
            [&](const FrameProgress& progress) { meter.update(picture, progress); },
            request->checkpoint.get());
    }
    statistics_.rays += frame.rays;
    statistics_.ambient += frame.ambient;
    meter.finish(frame.complete, statistics_.rays.total() - before.total());
    warnings_.use_terminal_line(false);
    if (!frame.complete) return std::nullopt;
    return frame;
}

/// False: interrupted.
bool LocalPictures::run_prepass(const PictureRequest& request, ProgressMeter& meter) {
    if (!session_.freezable) return true;
    const CachePrepassResult played =
        fill_ambient_cache(session_.tracer(), request.camera, request.options, prepass_,
                           *session_.freezable, executor_, contexts_, interrupt_flag(),
                           [&](const FrameProgress& progress) { meter.update(0, progress); });
    statistics_.rays += played.rays;
    statistics_.ambient += played.ambient;
    return played.complete;
}

}  // namespace lightwalk
