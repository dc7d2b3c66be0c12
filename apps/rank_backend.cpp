#include "apps/rank_backend.h"

#include <deque>
#include <utility>

#include "apps/rank_frames.h"
#include "apps/rank_pictures.h"
#include "apps/rank_report.h"
#include "apps/rank_session.h"
#include "apps/rank_walk.h"
#include "apps/session/local_backend.h"
#include "apps/session/local_rays.h"

namespace lightwalk {
namespace {

/// Rank 0's lists of rays, which all ranks answer.
class RankRays final : public RayMaker {
  public:
    RankRays(RankLink& link, const StopFlag& stop) : link_(link), stop_(stop) {}

    void order(RayTask list) override {
        RayChunk chunk{next_++, list.first, {}};
        chunk.numbers.reserve(6 * list.rays.size());
        for (const RayQuery& query : list.rays) {
            for (const Vec3& v : {query.origin, query.direction})
                chunk.numbers.insert(chunk.numbers.end(), {v.x, v.y, v.z});
        }
        link_.submit(std::move(chunk));
        if (demand_.lists > 0) --demand_.lists;
    }

    [[nodiscard]] std::optional<std::string> take() override {
        while (answers_.empty() && !stop_.requested()) receive_news(true);
        if (answers_.empty()) return std::nullopt;
        std::string answer = std::move(answers_.front());
        answers_.pop_front();
        return answer;
    }

    [[nodiscard]] RayDemand demand(bool wait) override {
        receive_news(wait && answers_.empty());
        demand_.answered = !answers_.empty();
        return demand_;
    }

  private:
    void receive_news(bool wait) {
        RankLink::RayNews news = link_.ray_news(wait, stop_);
        demand_.lists += news.chunks;
        if (news.rays > 0) demand_.rays = news.rays;
        for (RayAnswer& answer : news.answers) answers_.push_back(std::move(answer.bytes));
    }

    RankLink& link_;
    const StopFlag& stop_;
    std::uint64_t next_ = 0;
    RayDemand demand_;
    std::deque<std::string> answers_;  ///< in the order of the lists
};

std::string answer_chunk(const RayChunk& chunk, const Tracer& tracer, TraceContext& context,
                         const RendererOptions& options) {
    RayTask list;
    list.first = chunk.first;
    list.rays.resize(chunk.rays());
    for (std::size_t i = 0; i < list.rays.size(); ++i) {
        const double* const v = &chunk.numbers[6 * i];
        list.rays[i] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    }
    return answer_rays(tracer, context, list, options);
}

bool draws_pictures(const RendererOptions& options) {
    return !options.answers_rays;
}

}  // namespace

/// Rank 0's frames of a walk that is steered, and what they need.
class RankBackend::Frames {
  public:
    Frames(RankLink& link, const Tracer& direct, const Tracer* indirect,
           const RendererOptions& options, const FrameOptions& picture, WarningSink& warnings)
        : executor_(make_executor(options)),
          frames_(link, direct, indirect, *options.reuse, picture, *executor_, warnings) {}
    [[nodiscard]] RankFrames& get() { return frames_; }

  private:
    std::unique_ptr<Executor> executor_;  ///< of what rank 0 draws by itself
    RankFrames frames_;
};

Renderer open_renderer(RankLink* link, const RendererRequest& request, WarningSink& warnings) {
    if (link != nullptr)
        return Renderer(std::make_unique<RankBackend>(
            *link,
            build_on_ranks(*link, request.source, request.scene_from,
                           {request.options.light, request.options.ambient_file}, request.history,
                           warnings, request.files),
            request));
    const auto scene = std::make_shared<CompiledScene>(
        request.source, warnings, std::make_shared<FileRecorder>(request.files));
    if (request.when_read) request.when_read();
    scene->compile();
    return Renderer(std::make_unique<LocalBackend>(scene, request.options));
}

RankBackend::RankBackend(RankLink& link, std::unique_ptr<SceneSession> session,
                         const RendererRequest& request)
    : RenderBackend(request.options),
      link_(link),
      session_(std::move(session)),
      projectors_(request.projectors),
      executor_(make_executor(options())),
      contexts_(session_->tracer(), warnings(), executor_->concurrency()) {
    // The rounds of all ranks begin with the same cache.
    if (prepass() == CachePrepass::deterministic) link_.spread(session_->known, *session_->ambient);
    if (options().steered) direct_ = without_indirect(*session_, warnings());
    if (draws_pictures(options())) work_ = make_work();
}

RankBackend::~RankBackend() = default;

std::unique_ptr<RankWork> RankBackend::make_work() {
    if (!options().reuse)
        return std::make_unique<RankPictures>(link_, session_->tracer(), frame_options(0, 0),
                                              session_->freezable.get(), contexts_, warnings(),
                                              stop());
    const CachePrepass first = options().steered ? CachePrepass::none : prepass();
    auto walk =
        std::make_unique<RankWalk>(link_, *session_, first, frame_options(0, 0), *options().reuse,
                                   projectors_, contexts_, warnings(), stop());
    if (direct_) {
        direct_light_.emplace(*direct_, warnings(), executor_->concurrency());
        walk->set_direct(*direct_light_);
    }
    return walk;
}

void RankBackend::trace() {
    if (work_) return work_->trace(*executor_);
    link_.trace_rays(
        *executor_,
        [this](const RayChunk& chunk, int worker) {
            return answer_chunk(chunk, session_->tracer(), contexts_[worker], options());
        },
        stop());
}

void RankBackend::follow() {
    if (link_.traces())
        trace();
    else
        link_.wait_for_end(stop());
}

void RankBackend::run(FunctionRef<void()> lead) {
    if (options().steered) return run_steered(lead);
    if (!link_.leads()) {
        follow();
        return link_.report(report());
    }
    lead_ranks(
        link_, [this] { trace(); },
        [&] {
            lead();
            pictures_.reset();  // adds what rank 0 traced by itself
            statistics_.reports = link_.finish(stop());
        });
    statistics_.reports[0] = report();
    for (const auto& [rank, text] : statistics_.reports)
        add_report(text, statistics_.rays, statistics_.ambient);
}

/// Several such walks may follow each other: nobody reports what one took.
void RankBackend::run_steered(FunctionRef<void()> lead) {
    if (!link_.leads()) {
        follow();
    } else {
        lead_ranks(
            link_, [this] { trace(); },
            [&] {
                lead();
                link_.dismiss();
            });
    }
    link_.forget_cache();
}

PictureMaker& RankBackend::pictures() {
    if (pictures_) return *pictures_;
    if (options().reuse)
        pictures_ = std::make_unique<LeadWalk>(link_, session_->tracer(), *options().reuse,
                                               options().frames, listener(), warnings(), stop(),
                                               statistics_);
    else
        pictures_ = std::make_unique<LeadPictures>(link_, session_->tracer(), prepass(), contexts_,
                                                   listener(), stop());
    return *pictures_;
}

RayMaker& RankBackend::rays() {
    if (!rays_) rays_ = std::make_unique<RankRays>(link_, stop());
    return *rays_;
}

LiveFrames& RankBackend::frames() {
    if (frames_) return frames_->get();
    const Tracer& tracer = direct_ ? *direct_ : session_->tracer();
    const Tracer* const indirect = direct_ ? &session_->tracer() : nullptr;
    frames_ = std::make_unique<Frames>(link_, tracer, indirect, options(), frame_options(0, 0),
                                       warnings());
    return frames_->get();
}

RunStatistics RankBackend::statistics() const {
    RunStatistics statistics = statistics_;
    statistics.ranks = link_.ranks();
    statistics.threads = executor_->concurrency();
    statistics.add_session(*session_);
    return statistics;
}

std::string RankBackend::report() const {
    return rank_report(link_, executor_->concurrency(), work_ ? work_->rays() : contexts_.rays(),
                       work_ ? work_->ambient() : contexts_.ambient());
}

}  // namespace lightwalk
