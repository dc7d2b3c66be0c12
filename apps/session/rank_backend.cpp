// A run on ranks, and what rank 0's program does in it.
#include "apps/session/rank_backend.h"

#include <algorithm>
#include <exception>
#include <string>
#include <thread>
#include <utility>

#include "apps/session/listed_rays.h"
#include "apps/session/picture_order.h"
#include "core/error.h"
#include "parallel/comm/model_fields.h"
#include "parallel/executor_task_runner.h"

namespace lightwalk {

RankBackend::RankBackend(RankLink& link, std::shared_ptr<const CompiledScene> scene,
                         RendererOptions options)
    : RenderBackend(std::move(scene), std::move(options), link.leads()), link_(link) {
    light_frames();
    if (!session_->coefficients) return;
    std::vector<RayTally*> tallies;
    for (const std::unique_ptr<RayTally>& tally : tallies_) tallies.push_back(tally.get());
    rounds_ = std::make_unique<CoefficientRounds>(session_->tracer(), *session_->coefficients,
                                                  *executor_, contexts_, std::move(tallies),
                                                  link_.everyone(), stop());
}

void RankBackend::share_values() {
    if (!session_->ambient) return;
    // The rounds of a deterministic run begin with the same cache on all ranks.
    if (options_.deterministic || link_.exchanges_values()) {
        const std::string known =
            link_.broadcast(leads() ? wire::encode(session_->known) : std::string());
        const auto records = wire::decode<std::vector<AmbientRecord>>(known);
        for (const AmbientRecord& record : records)
            if (!leads()) session_->ambient->insert(record);
    }
    if (link_.exchanges_values()) link_.share(*session_->freezable);
}

void RankBackend::run(FunctionRef<void()> lead) {
    if (link_.leads()) {
        std::jthread tracing([this] {
            try {
                link_.guard([this] { trace(); });
            } catch (const Aborted&) {  // so is the program
            }
        });
        link_.guard([&] {
            lead();
            if (rounds_) (void)link_.everyone().all_gather({});  // no more lists
            link_.dismiss();
            const auto others = static_cast<std::size_t>(link_.ranks() - 1);
            while (statistics_.reports.size() < others && !stop().requested()) receive_news(true);
        });
        tracing.join();
        statistics_.reports[0] = report();
        for (const auto& [rank, report] : statistics_.reports) {
            statistics_.rays += report.rays;
            statistics_.ambient += report.ambient;
        }
    } else {
        trace();
        link_.post(0, Notice{Report{wire::encode(report())}});
    }
    link_.end_work();
}

void RankBackend::begin(const PictureRequest& request) {
    if (!options_.reuse && !options_.goal.given()) order(request);
}

void RankBackend::order(const PictureRequest& request) {
    const FrameOptions& options = request.options;
    PictureOrder order;
    order.view = request.camera.view();
    if (request.previous) order.previous = request.previous->view();
    order.width = options.width;
    order.height = options.height;
    order.first = request.first;
    if (request.tiles) {
        order.samples = options.pixels.samples;
        order.seed = options.seed;
        order.tiles = request.tiles->bytes();
    }
    const std::string payload = wire::encode(order);
    if (request.first && prepass() == CachePrepass::quick)
        link_.start({PictureJob{
            link_.new_number(), quick_prepass(options).whole(), 1, false, payload, {}, false}});
    const BlockRenderer renderer(session_->tracer(), request.camera, options, contexts_, stop());
    kept_rounds_ = request.checkpoint;
    PictureJob job{
        link_.new_number(),           options.area(), renderer.alignment(), true, payload, {},
        request.checkpoint != nullptr};
    std::vector<BlockPixels> known;
    if (request.checkpoint) known = request.checkpoint->known();
    for (const BlockPixels& block : known) job.known.push_back(block.block);
    jobs_.push_back({job.job, request.checkpoint, 0, std::nullopt});
    link_.start({job});
    const std::vector<int> workers = link_.topology().worker_ranks();
    const SubImages parts(job.area, workers.size());
    for (BlockPixels& block : known) {
        const Pixels pixels{{job.job, block.block}, std::move(block.values)};
        for (const std::size_t i : parts.overlapping(block.block))
            link_.post(workers[i], WorkResult{cut_pixels(pixels, parts[i])});
    }
}

std::optional<Frame> RankBackend::finish(const PictureRequest& request) {
    if (options_.reuse) return draw_frame(request, 1);
    if (options_.goal.given())
        return draw_until_good(request, [&](const PictureRequest& pass, TakeProgress progress) {
            order(pass);
            return receive(pass, progress);
        });
    WorkPhase phase;
    phase.pixels = static_cast<double>(request.options.area().pixels());
    ProgressReporter reporter(listener(), {phase});
    std::optional<Frame> frame =
        receive(request, [&](const FrameProgress& made) { reporter.update(0, made); });
    reporter.finish(frame.has_value(), 0);
    return frame;
}

std::optional<Frame> RankBackend::receive(const PictureRequest& request, TakeProgress progress) {
    const Job& job = jobs_.front();
    if (request.first) listen_to_rounds(request.camera, request.options);
    for (double told = -1; !job.picture && !stop().requested(); receive_news(true))
        if (job.done > std::exchange(told, job.done)) progress({job.done, 0, 0});
    std::optional<Frame> frame;
    if (job.picture)
        frame = assemble_picture(*job.picture, request.options.width, request.options.height);
    jobs_.pop_front();
    return frame;
}

void RankBackend::begin(const RayTask& list) {
    if (rounds_) return;
    link_.add({next_chunk_++, list.first, numbers_of(list)});
    if (demand_.lists > 0) --demand_.lists;
}

std::optional<std::string> RankBackend::finish(const RayTask& list) {
    if (rounds_) return answer_together(list);
    while (answers_.empty() && !stop().requested()) receive_news(true);
    if (answers_.empty()) return std::nullopt;
    std::string answer = std::move(answers_.front());
    answers_.pop_front();
    return answer;
}

RayDemand RankBackend::ray_demand(bool wait, bool begun) {
    if (rounds_) return demand_of_threads(begun);
    receive_news(wait && answers_.empty());
    demand_.answered = !answers_.empty();
    return demand_;
}

LiveFrames& RankBackend::frames() {
    if (frames_) return *frames_;
    own_executor_ = options_.steered ? make_executor(options_.executor.value_or(kDefaultExecutor),
                                                     executor_->concurrency())
                                     : make_executor(ExecutorKind::serial, 1);
    frames_ = std::make_unique<RankFrames>(
        [this](FrameOrder order, const StopFlag& stop) { return draw(std::move(order), stop); },
        direct_ ? *direct_ : session_->tracer(), direct_ ? &session_->tracer() : nullptr,
        *options_.reuse, frame_options(0, 0), *own_executor_, warnings_);
    if (contexts_.light_groups() != nullptr) frames_->keep_groups(contexts_.shared_groups());
    return *frames_;
}

/// Rank 0 makes its scene at the same time as the others, whose tracing threads do so once they are
/// done with the frame before; its own ones say no more than that they are.
void RankBackend::change_model(const ModelChange& change) {
    ChangeOrder order;
    order.number = change_ = link_.new_number();
    answers_to_change_.clear();
    order.payload = wire::encode(change);
    if (frames_ && frames_->outdated()) order.shown = frames_->outdated()->flags();
    link_.start({order});
    order.payload.clear();
    ChangedScene next;
    try {
        std::exception_ptr problem;
        try {
            next = make_changed(changed_scene(change));
        } catch (const std::exception&) {
            problem = std::current_exception();
        }
        wait_for_prepared();
        if (problem) std::rethrow_exception(problem);
        check_prepared();
    } catch (const std::exception& error) {
        order.step = ChangeOrder::Step::drop;
        link_.start({order});
        throw InputError(error.what());
    }
    if (frames_) frames_->set_kept(kept_points());
    take(std::move(next), order.number);
    order.step = ChangeOrder::Step::take;
    link_.start({order});
}

void RankBackend::wait_for_prepared() {
    const std::size_t all = link_.topology().workers.size();
    while (answers_to_change_.size() < all) {
        if (stop().requested()) throw InputError("the walk ends");
        receive_news(true);
    }
}

void RankBackend::check_prepared() const {
    for (const auto& [rank, said] : answers_to_change_)
        if (!said.problem.empty())
            throw InputError("rank " + std::to_string(rank) + ": " + said.problem);
}

double RankBackend::kept_points() const {
    double points = 0, kept = 0;
    for (const auto& [rank, said] : answers_to_change_) {
        points += static_cast<double>(said.points);
        kept += static_cast<double>(std::min(said.kept_points, said.points));
    }
    return points > 0 ? kept / points : 0;
}

/// Nothing: stopped.
std::optional<AssembledFrame> RankBackend::draw(FrameOrder order, const StopFlag& stop) {
    // A frame that has a time to end, and is shared out, waits for four messages one after the
    // other.
    constexpr double kLongRoundTrip = 0.004;
    order.number = link_.new_number();
    order.apart = order.budget > 0 && link_.round_trip() > kLongRoundTrip &&
                  link_.owners().size() == link_.topology().workers.size();
    link_.start({order});
    if (!options_.steered)
        listen_to_rounds(Camera(wire::decode<PictureOrder>(order.payload).view),
                         frame_options(order.width, order.height));
    for (frame_.reset(); !frame_; receive_news(true))
        if (stop.requested()) return std::nullopt;
    return assemble_frame(order, *frame_, ExecutorTaskRunner(*own_executor_));
}

/// Handles the news of the link. @param wait  until there is something
void RankBackend::receive_news(bool wait) {
    const auto with_job = [&](JobId number, auto use) {
        const auto job = std::find_if(jobs_.begin(), jobs_.end(),
                                      [&](const Job& one) { return one.number == number; });
        if (job != jobs_.end()) use(*job);
    };
    for (ProgramNews& some : link_.take_news(wait, stop())) {
        std::visit(
            Overloaded{
                [&](const Progress& news) {
                    with_job(news.job, [&](Job& job) { job.done = news.done; });
                },
                [&](FinishedPicture& news) {
                    with_job(news.job, [&](Job& job) { job.picture = std::move(news); });
                },
                [&](LoggedPixels& news) {
                    const JobBlock& work = news.pixels.work;
                    with_job(work.job, [&](const Job& job) {
                        if (job.checkpoint)
                            job.checkpoint->keep({work.block, std::move(news.pixels.values), {}});
                    });
                },
                [&](const ChunksWanted& news) {
                    demand_.lists += news.chunks;
                    demand_.rays = news.rays;
                },
                [&](RayAnswer& news) { answers_.push_back(std::move(news.bytes)); },
                [&](FinishedFrame& news) { frame_ = std::move(news); },
                [&](RankNotice& news) {
                    if (const auto* report = std::get_if<Report>(&news.notice.notice))
                        statistics_.reports[news.from] = wire::decode<RankReport>(report->payload);
                    auto* prepared = std::get_if<PreparedChange>(&news.notice.notice);
                    if (prepared != nullptr && prepared->number == change_ &&
                        link_.topology().traces(news.from))
                        answers_to_change_[news.from] = std::move(*prepared);
                }},
            some);
    }
}

RunStatistics RankBackend::statistics() const {
    RunStatistics statistics = RenderBackend::statistics();
    statistics.ranks = link_.ranks();
    return statistics;
}

}  // namespace lightwalk
