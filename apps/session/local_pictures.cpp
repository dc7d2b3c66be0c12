#include "apps/session/local_pictures.h"

#include "parallel/time_estimate.h"

namespace lightwalk {

std::optional<Frame> LocalPictures::take() {
    const std::shared_ptr<const PictureRequest> request = std::move(requests_.front());
    requests_.pop_front();
    const std::vector<WorkPhase> phases =
        plan_picture(request->options, prepass_, workers_.executor.concurrency());
    const std::size_t picture = phases.size() - 1;
    RunStatistics& statistics = workers_.statistics;
    const RayCounters before = statistics.rays;
    ProgressReporter reporter(listener_, phases);
    Frame frame;
    if (run_prepass(*request, reporter)) {
        frame = render_frame(
            workers_.session.tracer(), request->camera, request->options, workers_.executor,
            workers_.contexts, workers_.stop,
            [&](const FrameProgress& progress) { reporter.update(picture, progress); },
            request->checkpoint.get());
    }
    statistics.rays += frame.rays;
    statistics.ambient += frame.ambient;
    reporter.finish(frame.complete, statistics.rays.total() - before.total());
    if (!frame.complete) return std::nullopt;
    return frame;
}

/// False: stopped.
bool LocalPictures::run_prepass(const PictureRequest& request, ProgressReporter& reporter) {
    const SceneSession& session = workers_.session;
    if (!session.freezable) return true;
    const CachePrepassResult filled =
        fill_ambient_cache(session.tracer(), request.camera, request.options, prepass_,
                           *session.freezable, workers_.executor, workers_.contexts, workers_.stop,
                           [&](const FrameProgress& progress) { reporter.update(0, progress); });
    workers_.statistics.rays += filled.rays;
    workers_.statistics.ambient += filled.ambient;
    return filled.complete;
}

}  // namespace lightwalk
