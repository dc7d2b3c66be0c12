#include "apps/session/local_backend.h"

#include <utility>
#include <vector>

#include "io/files/large_pages.h"
#include "parallel/ray_list.h"
#include "parallel/time_estimate.h"

namespace lightwalk {
namespace {

/// Texts one after the other; each goes as soon as it is copied.
std::string joined(std::vector<std::string> texts) {
    if (texts.size() == 1) return std::move(texts.front());
    std::size_t size = 0;
    for (const std::string& text : texts) size += text.size();
    std::string all;
    all.reserve(size);
    prefer_large_pages(all);
    for (std::string& text : texts) all += std::exchange(text, {});
    return all;
}

}  // namespace

LocalBackend::LocalBackend(std::shared_ptr<const CompiledScene> scene, RendererOptions options)
    : RenderBackend(std::move(scene), std::move(options), true) {
    if (options_.observer != nullptr) contexts_[0].observer = options_.observer;
    if (!session_->coefficients) return;
    std::vector<RayTally*> tallies;
    for (const std::unique_ptr<RayTally>& tally : tallies_) tallies.push_back(tally.get());
    rounds_ =
        std::make_unique<CoefficientRounds>(session_->tracer(), *session_->coefficients, *executor_,
                                            contexts_, std::move(tallies), alone_, stop());
}

std::optional<Frame> LocalBackend::finish(const PictureRequest& request) {
    if (options_.reuse) return draw_frame(request, executor_->concurrency());
    if (options_.goal.given())
        return draw_until_good(request, [&](const PictureRequest& pass, TakeProgress progress) {
            return draw_pass(pass, progress);
        });
    const std::vector<WorkPhase> phases =
        plan_picture(request.options, prepass(), executor_->concurrency());
    const std::size_t picture = phases.size() - 1;
    const std::uint64_t before = statistics_.rays.total();
    ProgressReporter reporter(listener(), phases);
    Frame frame;
    if (fill_cache(request, [&](const FrameProgress& made) {
            reporter.update(0, made);
        }).complete) {
        frame = render_frame(
            session_->tracer(), request.camera, request.options, *executor_, contexts_, stop(),
            [&](const FrameProgress& made) { reporter.update(picture, made); },
            request.checkpoint.get());
    }
    statistics_.rays += frame.rays;
    statistics_.ambient += frame.ambient;
    reporter.finish(frame.complete, statistics_.rays.total() - before);
    if (!frame.complete) return std::nullopt;
    return frame;
}

/// The first pass of a picture fills the cache for all of them, and has the rays of that.
std::optional<Frame> LocalBackend::draw_pass(const PictureRequest& pass, TakeProgress progress) {
    CachePrepassResult filled;
    if (pass.first) filled = fill_cache(pass, progress);
    if (pass.first && !filled.complete) return std::nullopt;
    const auto with_filled = [&](const FrameProgress& made) {
        progress({made.done, filled.rays.total() + made.rays,
                  filled.ambient.computed + made.ambient_values});
    };
    Frame frame = render_frame(session_->tracer(), pass.camera, pass.options, *executor_, contexts_,
                               stop(), with_filled);
    statistics_.rays += frame.rays;
    statistics_.ambient += frame.ambient;
    if (!frame.complete) return std::nullopt;
    frame.rays += filled.rays;
    frame.ambient += filled.ambient;
    return frame;
}

/// Counted in the statistics. Not complete: stopped.
CachePrepassResult LocalBackend::fill_cache(const PictureRequest& request, TakeProgress progress) {
    CachePrepassResult filled;
    filled.complete = true;
    if (!session_->freezable) return filled;
    filled = fill_ambient_cache(session_->tracer(), request.camera, request.options, prepass(),
                                *session_->freezable, *executor_, contexts_, stop(), progress,
                                nullptr, request.checkpoint.get());
    statistics_.rays += filled.rays;
    statistics_.ambient += filled.ambient;
    return filled;
}

/// The first frame fills the ambient cache for all; a deterministic walk has each do so, whose rays
/// find the cache frozen.
bool LocalBackend::prepare(const PictureRequest& request, bool first) {
    if (!first && prepass() != CachePrepass::deterministic) return true;
    return fill_cache(request, [](const FrameProgress&) {}).complete;
}

LiveFrames& LocalBackend::frames() {
    if (frames_) return *frames_;
    const Tracer& tracer = direct_ ? *direct_ : session_->tracer();
    const Tracer* const indirect = direct_ ? &session_->tracer() : nullptr;
    frames_ = std::make_unique<LocalFrames>(tracer, indirect, *options_.reuse, frame_options(0, 0),
                                            *executor_, warnings_);
    if (contexts_.light_groups() != nullptr) frames_->keep_groups(contexts_.shared_groups());
    return *frames_;
}

void LocalBackend::change(const std::shared_ptr<const CompiledScene>& scene) {
    ChangedScene next = make_changed(scene);
    take_over(next, frames_.get());
}

/// Records of coefficients for what the rays' hemispheres see, before any of these is answered: an
/// answer depends on the list as a whole, not on what is answered when.
void LocalBackend::fill_coefficients(const RayTask& list) {
    (void)rounds_->fill([&] {
        trace_ray_list(session_->tracer(), contexts_, list.rays, list.first, ray_options(),
                       *executor_, 1,
                       [](std::size_t, int, const Ray& /*ray*/, const Hit& /*first*/) {});
    });
}

std::optional<std::string> LocalBackend::finish(const RayTask& list) {
    if (stop().requested()) return std::nullopt;
    const std::size_t per_task = options_.long_rays ? 1 : kRaysPerTask;
    std::vector<std::string> records((list.rays.size() + per_task - 1) / per_task);
    contexts_.reset_counters();
    if (rounds_) fill_coefficients(list);
    if (stop().requested()) return std::nullopt;
    trace_ray_list(session_->tracer(), contexts_, list.rays, list.first, ray_options(), *executor_,
                   per_task, [&](std::size_t i, int worker, const Ray& ray, const Hit& first) {
                       record(worker, list.rays[i], ray, first, records[i / per_task]);
                   });
    statistics_.rays += contexts_.rays();
    statistics_.ambient += contexts_.ambient();
    return joined(std::move(records));
}

RayDemand LocalBackend::ray_demand(bool /*wait*/, bool begun) {
    return demand_of_threads(begun);
}

}  // namespace lightwalk
