// What every rank that traces does for a run.
#include <optional>
#include <span>
#include <utility>

#include "apps/session/listed_rays.h"
#include "apps/session/picture_order.h"
#include "apps/session/rank_backend.h"
#include "core/error.h"
#include "parallel/comm/model_fields.h"
#include "parallel/ranks/trace_work.h"
#include "parallel/ray_list.h"

namespace lightwalk {
namespace {

/// A renderer and what it refers to.
struct OrderedPicture {
    OrderedPicture(const PictureOrder& order, const FrameOptions& wanted, const Tracer& tracer,
                   WorkerContexts& contexts, const StopFlag& stop)
        : request(order.view, order.previous ? &*order.previous : nullptr, wanted) {
        if (order.samples > 0) take_pass(order);
        renderer.emplace(tracer, request.camera, request.options, contexts, stop);
    }
    void take_pass(const PictureOrder& order) {
        request.tiles.emplace(order.width, order.height);
        if (!request.tiles->set_bytes(order.tiles))
            throw InputError("a rank has got a pass over a picture of another size");
        request.options.tiles = &*request.tiles;
        request.options.pixels.samples = order.samples;
        request.options.seed = order.seed;
    }
    PictureRequest request;
    std::optional<BlockRenderer> renderer;
};

}  // namespace

void RankBackend::trace() {
    if (rounds_ && !leads()) return answer_lists();
    if (!link_.traces() || rounds_) return link_.inbox().wait_for_end(stop());
    if (options_.reuse) {
        CloudOptions cloud = *options_.reuse;
        if (contexts_.light_groups() != nullptr)
            cloud.light_groups = contexts_.light_groups()->size();
        return draw_frames(link_, cloud, walk_scene(), *executor_, stop());
    }
    trace_work(link_,
               {[this](const PictureJob& job) { return make_renderer(job); },
                [this](const RayChunk& chunk, int worker) { return answer_chunk(chunk, worker); }},
               *executor_, stop());
}

/// On rank 0 its program makes the scene, and takes it before the others are told to: its threads
/// wait for the next order then.
WalkScene RankBackend::walk_scene() {
    WalkScene scene;
    scene.make_rays = [this](const FrameOrder& order) { return make_rays(order); };
    scene.prepare = [this](const std::string& payload) {
        if (leads()) return;
        const auto change = wire::decode<ModelChange>(payload);
        check_sound(change, session_->compiled().model());
        prepared_ = make_changed(changed_scene(change));
    };
    scene.take = [this](FrameNumber number) -> std::size_t {
        if (!leads()) {
            if (!prepared_) throw InputError("a scene is to be taken that was not prepared");
            take(std::move(*prepared_), number);
            prepared_.reset();
        }
        return contexts_.light_groups() != nullptr ? contexts_.light_groups()->size() : 0;
    };
    scene.drop = [this] { prepared_.reset(); };
    return scene;
}

void RankBackend::take(ChangedScene next, FrameNumber number) {
    if (link_.exchanges_values()) link_.share(*next.session->freezable, number);
    take_over(next, frames_.get());
    light_frames();
}

void RankBackend::light_frames() {
    if (light_) {
        past_counters_.rays += light_->contexts.rays();
        past_counters_.ambient += light_->contexts.ambient();
    }
    if (options_.reuse) light_.emplace(session_->tracer(), warnings_, executor_->concurrency());
    direct_light_.reset();
    if (direct_) direct_light_.emplace(*direct_, warnings_, executor_->concurrency());
    for (std::optional<WalkLight>* light : {&light_, &direct_light_})
        if (*light && contexts_.light_groups() != nullptr)
            (*light)->contexts.sum_by(contexts_.shared_groups());
}

std::shared_ptr<const BlockRenderer> RankBackend::make_renderer(const PictureJob& job) {
    const auto order = wire::decode<PictureOrder>(job.payload);
    FrameOptions options = frame_options(order.width, order.height);
    if (!job.keep) options = quick_prepass(options);
    const auto picture =
        std::make_shared<OrderedPicture>(order, options, session_->tracer(), contexts_, stop());
    if (order.first && prepass() == CachePrepass::deterministic) {
        // Rank 0 orders no other picture meanwhile, so that no rays of another one are under way.
        // The tracing threads wait, and theirs is not to be called from one of its own tasks.
        const auto executor = make_executor(ExecutorKind::threads, executor_->concurrency());
        fill_cache(picture->request.camera, picture->request.options, CachePrepass::deterministic,
                   *executor);
    }
    return {picture, &*picture->renderer};
}

std::string RankBackend::answer_chunk(const RayChunk& chunk, int worker) {
    return answer_rays(list_of({chunk.first, chunk.numbers}), worker);
}

/// Rank 0's program gives the lists; an empty one is the end.
void RankBackend::answer_lists() {
    for (;;) {
        const std::string told = link_.everyone().all_gather({}).front();
        if (told.empty()) return;
        const auto list = wire::decode<ListedRays>(told);
        std::optional<std::string> bytes = answer_share(list_of(list));
        if (!bytes) return;
        const auto rank = static_cast<std::uint64_t>(link_.rank());
        const auto ranks = static_cast<std::uint64_t>(link_.ranks());
        link_.post(0, WorkResult{RayAnswer{ranks * next_chunk_++ + rank, *std::move(bytes)}});
    }
}

std::optional<std::string> RankBackend::answer_share(const RayTask& list) {
    const auto rank = static_cast<std::size_t>(link_.rank());
    const auto ranks = static_cast<std::size_t>(link_.ranks());
    const std::size_t begin = list.rays.size() * rank / ranks;
    const std::size_t end = list.rays.size() * (rank + 1) / ranks;
    const std::span<const RayQuery> own = std::span(list.rays).subspan(begin, end - begin);
    const auto trace = [&](TakeListedRay take) {
        trace_ray_list(session_->tracer(), contexts_, own, list.first + begin, ray_options(),
                       *executor_, 1, take);
    };
    const bool filled = rounds_->fill(
        [&] { trace([](std::size_t, int, const Ray& /*ray*/, const Hit& /*first*/) {}); });
    if (!filled) return std::nullopt;
    std::vector<std::string> records(own.size());
    trace([&](std::size_t i, int worker, const Ray& ray, const Hit& first) {
        record(worker, own[i], ray, first, records[i]);
    });
    std::string all;
    for (const std::string& one : records) all += one;
    return all;
}

std::optional<std::string> RankBackend::answer_together(const RayTask& list) {
    (void)link_.everyone().all_gather(wire::encode(ListedRays{list.first, numbers_of(list)}));
    std::optional<std::string> own = answer_share(list);
    if (!own) return std::nullopt;
    const auto ranks = static_cast<std::size_t>(link_.ranks());
    link_.post(0, WorkResult{RayAnswer{ranks * next_chunk_++, *std::move(own)}});
    while (answers_.size() < ranks && !stop().requested()) receive_news(true);
    if (answers_.size() < ranks) return std::nullopt;
    std::string all;
    for (const std::string& share : std::exchange(answers_, {})) all += share;
    return all;
}

/// The first frame fills the ambient cache for all; a deterministic walk has each do so. Of a quick
/// prepass each rank does a part: what it finds goes to the others as all values do.
std::unique_ptr<SceneCaster> RankBackend::make_rays(const FrameOrder& order) {
    FrameOptions options = frame_options(order.width, order.height);
    const auto picture = wire::decode<PictureOrder>(order.payload);
    const bool direct = direct_light_ && !picture.indirect;
    WalkLight& light = direct ? *direct_light_ : *light_;
    mixture_ = order.mixture;
    auto rays = std::make_unique<SceneCaster>(light.tracer, light.visibility, Camera(picture.view),
                                              options, light.contexts, stop(),
                                              use_of_frame(order.budget, order.rests), &mixture_);
    const CachePrepass how = direct || options_.steered ? CachePrepass::none : prepass();
    const bool deterministic = how == CachePrepass::deterministic;
    if (how == CachePrepass::none || (!order.rules.empty && !deterministic)) return rays;
    if (!deterministic) {
        const Group& workers = link_.workers();
        const SubImages parts(options.whole(), static_cast<std::size_t>(workers.size()));
        options.window = parts[static_cast<std::size_t>(workers.index())];
        if (options.window->empty()) return rays;
    }
    fill_cache(rays->camera(), options, how, *executor_);
    return rays;
}

void RankBackend::listen_to_rounds(const Camera& camera, const FrameOptions& options) {
    if (link_.traces() || prepass() != CachePrepass::deterministic) return;
    fill_cache(camera, options, CachePrepass::deterministic,
               *make_executor(ExecutorKind::serial, 1));
}

void RankBackend::fill_cache(const Camera& camera, const FrameOptions& options, CachePrepass how,
                             Executor& executor) {
    WorkerContexts contexts(session_->tracer(), warnings_, executor.concurrency());
    if (contexts_.light_groups() != nullptr) contexts.sum_by(contexts_.shared_groups());
    const CachePrepassResult filled = fill_ambient_cache(
        session_->tracer(), camera, options, how, *session_->freezable, executor, contexts, stop(),
        [](const FrameProgress&) {}, how == CachePrepass::deterministic ? &link_.rounds() : nullptr,
        kept_rounds_.get());
    past_counters_.rays += filled.rays;
    past_counters_.ambient += filled.ambient;
}

RankReport RankBackend::report() const {
    RankReport report = link_.report();
    report.threads = executor_->concurrency();
    for (const WorkerContexts* contexts : {&contexts_, light_ ? &light_->contexts : nullptr}) {
        if (contexts == nullptr) continue;
        report.rays += contexts->rays();
        report.ambient += contexts->ambient();
    }
    report.rays += past_counters_.rays;
    report.ambient += past_counters_.ambient;
    return report;
}

}  // namespace lightwalk
