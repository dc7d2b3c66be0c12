#include "apps/rank_walk.h"

#include <utility>

#include "apps/rank_pictures.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk {
std::unique_ptr<LiveFrames> LeadWalk::make_frames(const FrameOptions& options) {
    return std::make_unique<RankFrames>(link_, tracer_, nullptr, this->options(), options,
                                        *executor_, warnings_);
}

void RankWalk::trace(Executor& executor) {
    link_.draw_walk(
        executor, cloud_, projectors_,
        [&](const FrameOrder& order) { return make_rays(order, executor); }, stop_);
}

std::unique_ptr<SceneCaster> RankWalk::make_rays(const FrameOrder& order, Executor& executor) {
    FrameOptions options = options_;
    options.width = order.width;
    options.height = order.height;
    const PictureOrder picture = decode_order(order.payload);
    if (direct_ != nullptr && !picture.indirect)
        return std::make_unique<SceneCaster>(direct_->tracer, direct_->visibility,
                                             Camera(picture.view), options, direct_->contexts,
                                             stop_);
    auto rays = std::make_unique<SceneCaster>(session_.tracer(), probe_, Camera(picture.view),
                                              options, contexts_, stop_);
    if (order.rules.empty || prepass_ == CachePrepass::deterministic)
        run_prepass(rays->camera(), options, executor);
    return rays;
}

/// Of a quick one each rank plays a part: what it finds goes to the others as all values do.
void RankWalk::run_prepass(const Camera& camera, FrameOptions options, Executor& executor) {
    if (prepass_ == CachePrepass::none || !session_.freezable) return;
    Group& workers = link_.workers();
    if (prepass_ == CachePrepass::quick) {
        const SubImages parts(options.whole(), static_cast<std::size_t>(workers.size()));
        options.window = parts[static_cast<std::size_t>(workers.index())];
        if (options.window->empty()) return;
    }
    WorkerContexts contexts(session_.tracer(), warnings_, executor.concurrency());
    const CachePrepassResult played = fill_ambient_cache(
        session_.tracer(), camera, options, prepass_, *session_.freezable, executor, contexts,
        stop_, [](const FrameProgress&) {},
        prepass_ == CachePrepass::deterministic ? &workers : nullptr);
    prepass_rays_ += played.rays;
    prepass_ambient_ += played.ambient;
}

RayCounters RankWalk::rays() const {
    RayCounters sum = prepass_rays_;
    sum += contexts_.rays();
    return sum;
}

AmbientCounters RankWalk::ambient() const {
    AmbientCounters sum = prepass_ambient_;
    sum += contexts_.ambient();
    return sum;
}

}  // namespace lightwalk
