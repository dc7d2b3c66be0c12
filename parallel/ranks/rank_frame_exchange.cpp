#include "parallel/ranks/rank_frame_exchange.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "core/cloud/shown_materials.h"
#include "core/error.h"
#include "parallel/ranks/piece_codec.h"
#include "parallel/ranks/trace_work.h"

namespace lightwalk {
namespace {

/// One frame, as long as it is drawn.
class RankFrameExchange final : public FrameExchange {
  public:
    RankFrameExchange(RankLink& link, const FrameOrder& order, const FrameCaster& rays,
                      std::size_t index, double last_keep_seconds)
        : link_(link),
          inbox_(link.inbox()),
          order_(order),
          rays_(rays),
          index_(index),
          rays_before_(rays.traced()),
          last_keep_seconds_(last_keep_seconds),
          parts_({0, 0, order.width, order.height}, link.owners().size()) {}

    [[nodiscard]] bool exchange_points(CloudRegion& region, const StopFlag& stop) override {
        std::vector<SharedPoints> leaving(parts_.size());
        region.points().leaving(
            [&](const CloudPoint& point, const PixelPlace& place, std::span<const Rgb> groups) {
                const PixelRectangle near = widened({place.x, place.y, place.x + 1, place.y + 1}, 1,
                                                    order_.width, order_.height);
                for (const std::size_t owner : parts_.overlapping(near)) {
                    SharedPoints& shared = leaving[owner];
                    shared.points.push_back(point);
                    shared.groups.insert(shared.groups.end(), groups.begin(), groups.end());
                }
            });
        for (std::size_t i = 0; i < leaving.size(); ++i)
            if (i != index_)
                link_.post(link_.owners()[i], PointExchange{order_.number, std::move(leaving[i])});
        const TimedActivity waiting(link_.timeline(), 0, Activity::wait);
        const auto arrived = inbox_.points(order_.number, parts_.size() - 1, stop);
        if (!arrived) return false;
        for (const SharedPoints& shared : *arrived) region.add(shared.points, shared.groups);
        return true;
    }

    void send_used(const CloudRegion& region) override {
        const UsedPixels used = region.points().used_beside();
        for (const std::size_t i : beside())
            link_.post(link_.owners()[i], PointExchange{order_.number, used});
    }

    [[nodiscard]] bool trace(CloudRegion& region, const UncachedPixelTracer& tracer, int sample,
                             Executor& executor, const StopFlag& stop) override {
        const std::size_t lists = order_.rests ? 0 : beside().size();
        if (order_.apart) {
            link_.post(0, UncachedPixels{order_.number, 0, {}});
            return trace_alone(region, tracer, sample, executor, stop) &&
                   gather(region, 0, lists, stop);
        }
        const TraceList& to_trace = region.to_trace();
        UncachedPixels pixels{order_.number, static_cast<std::uint32_t>(to_trace.noise_pairs()),
                              to_trace.places()};
        const std::size_t expected = pixels.places.size();
        link_.post(0, std::move(pixels));
        trace_runs(tracer, sample, executor, stop);
        return gather(region, expected, lists, stop);
    }

    /// All threads trace what comes, whoever owns it, until no more of the frame does.
    void trace_runs(const UncachedPixelTracer& tracer, int sample, Executor& executor,
                    const StopFlag& stop) {
        run_on_all(inbox_, executor, stop, [&](int worker) {
            const auto next = [&] {
                const TimedActivity waiting(link_.timeline(), worker, Activity::wait);
                return inbox_.next_run(order_.number, stop);
            };
            while (const std::optional<PixelRun> run = next())
                finish(trace_run(*run, tracer, sample, worker));
        });
    }

    void deliver(const FrameOrder&, CloudRegion& region) override {
        FramePart part;
        part.frame = order_.number;
        part.area = region.frame().area;
        if (order_.rests) {
            const std::span<const Rgb> groups = region.to_trace().groups();
            part.refined = region.to_trace().values();
            part.refined_groups.assign(groups.begin(), groups.end());
        } else {
            encode(region, part);
        }
        if (order_.tells_origins) part.origins = region.frame().origins;
        part.report = region.frame().report;
        part.report.rays = rays_.traced() - rays_before_;
        part.report.keep_seconds = last_keep_seconds_;
        link_.post(0, FinishedPart{std::move(part)});
    }

    [[nodiscard]] std::optional<AgeCounts> sum(const AgeCounts& mine) override {
        const std::vector<std::uint64_t> sums =
            link_.all_reduce(Collective::Group::owners, {mine.begin(), mine.end()});
        AgeCounts all{};
        if (sums.size() != all.size()) throw InputError("ranks count ages in different ways");
        std::copy(sums.begin(), sums.end(), all.begin());
        return all;
    }

  private:
    /// What others have traced of the own pixels, and used of the own points.
    [[nodiscard]] bool gather(CloudRegion& region, std::size_t expected, std::size_t lists,
                              const StopFlag& stop) {
        const TimedActivity waiting(link_.timeline(), 0, Activity::wait);
        const auto mail = inbox_.mail(order_.number, expected, lists, stop);
        if (!mail) return false;
        for (const UsedPixels& used : mail->used) region.points().mark_used(used);
        record(mail->runs, expected, region);
        return true;
    }
    [[nodiscard]] std::vector<std::size_t> beside() const {
        return owners_beside(parts_, index_, order_.width, order_.height);
    }

    [[nodiscard]] TracedRun trace_run(const PixelRun& run, const UncachedPixelTracer& tracer,
                                      int sample, int worker) const {
        const auto count = static_cast<std::uint32_t>(run.places.size());
        TracedRun result{run.frame, run.owner, run.first, count, {}};
        const TimedActivity tracing(link_.timeline(), worker, Activity::trace);
        const auto append = [](auto& all, const auto& some) {
            all.insert(all.end(), some.begin(), some.end());
        };
        const auto keep = [&](std::size_t, const TracedPixels& traced) {
            append(result.traced, traced.results);
            append(result.groups, traced.groups);
            append(result.ahead, traced.ahead);
        };
        tracer.trace_part(run.places, run.noise_pairs ? 1 : sample, worker, run.at_once, keep);
        return result;
    }

    void finish(TracedRun run) {
        FinishedWork finished{FinishedWork::Payload::pixels, 0, run.count, 0};
        if (run.traced.size() < run.count) finished.late = run.frame;
        link_.finish_work(finished, std::move(run));
    }

    /// Each pixel must have been dealt with, and once.
    static void record(std::span<const TracedRun> runs, std::size_t expected, CloudRegion& region) {
        const std::size_t uncached = region.to_trace().pixels().size(),
                          groups = region.to_trace().light_groups();
        std::vector<bool> there(expected);
        for (const TracedRun& run : runs) {
            const std::size_t end = std::size_t{run.first} + run.count;
            // What is handed out together is either of the one kind or of the other.
            const bool sound = end <= expected && (run.first >= uncached || end <= uncached) &&
                               run.traced.size() <= run.count &&
                               run.groups.size() == run.traced.size() * groups &&
                               run.ahead.size() == run.groups.size() &&
                               std::none_of(there.begin() + run.first,
                                            there.begin() + static_cast<std::ptrdiff_t>(end),
                                            [](bool is) { return is; });
            if (!sound) throw InputError("a rank has traced pixels that it should not have");
            std::fill(there.begin() + run.first, there.begin() + static_cast<std::ptrdiff_t>(end),
                      true);
            region.to_trace().record(run.first, run.traced, run.groups, run.ahead);
        }
    }

    void encode(CloudRegion& region, FramePart& part) const {
        const CloudFrame& frame = region.frame();
        std::vector<PixelValue> values(frame.radiance.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = {frame.radiance[i], frame.distance[i]};
        if (frame.report.filled > 0) {
            for (std::size_t i = 0; i < frame.known.size(); ++i)
                if (frame.known[i] == 0) part.unknown.push_back(static_cast<std::uint32_t>(i));
        }
        if (link_.leads() || link_.on_one_machine())
            part.pixels = std::move(values);
        else
            part.pixels = encode_piece(frame.area, values);
    }

    RankLink& link_;
    TracerInbox& inbox_;
    const FrameOrder& order_;
    const FrameCaster& rays_;
    std::size_t index_;  ///< of this rank among the workers, the first of which are the owners
    std::uint64_t rays_before_;
    double last_keep_seconds_;
    SubImages parts_;
};

/// All frames, of scene after scene.
class RankFrameLoop {
  public:
    RankFrameLoop(RankLink& link, const CloudOptions& cloud, const WalkScene& scene)
        : link_(link),
          cloud_(cloud),
          scene_(scene),
          clock_([&link] { return link.threads().now(); }),
          index_(link.topology().worker_index(link.rank()).value_or(0)) {
        frames_.emplace(cloud_, index_, link_.owners().size(), clock_);
    }

    void draw(const FrameOrder& order, Executor& executor, const StopFlag& stop) {
        const std::size_t levels = order.mixture.levels.size();
        if (levels != 0 && levels != cloud_.light_groups)
            throw InputError("a frame of a walk is ordered with levels of other light groups");
        const std::unique_ptr<FrameCaster> rays = scene_.make_rays(order);
        RankFrameExchange exchange(link_, order, *rays, index_, frames_->keep_seconds());
        if (owns()) {
            (void)frames_->draw(order, rays->camera(), *rays, exchange, executor, stop);
            return;
        }
        // A rank that owns no part has nothing to do before others have found what to trace.
        const auto deadline = order.budget > 0 ? clock_.in(order.budget)
                                               : UncachedPixelTracer::Clock::time_point::max();
        exchange.trace_runs(
            UncachedPixelTracer(*rays, cloud_.tolerance,
                                tracing_deadline(clock_, deadline, order.budget, 0), clock_),
            order.sample, executor, stop);
    }

    void follow(const ChangeOrder& change) {
        if (!scene_.prepare) throw InputError("the scene of these frames cannot be changed");
        switch (change.step) {
            case ChangeOrder::Step::prepare:
                link_.post(0, Notice{prepared(change)});
                return;
            case ChangeOrder::Step::take:
                cloud_.light_groups = scene_.take(change.number);
                if (change.shown.empty())  // of which nothing is kept
                    frames_.emplace(cloud_, index_, link_.owners().size(), clock_);
                else
                    frames_->drop(ShownMaterials(change.shown));
                return;
            case ChangeOrder::Step::drop:
                scene_.drop();
        }
    }

  private:
    [[nodiscard]] bool owns() const { return index_ < link_.owners().size(); }

    [[nodiscard]] PreparedChange prepared(const ChangeOrder& change) {
        PreparedChange told{change.number, {}, 0, 0};
        try {
            scene_.prepare(change.payload);
            if (change.shown.empty() || frames_->region() == nullptr) return told;
            const ShownMaterials outdated(change.shown);
            const std::span<const CloudPoint> points = frames_->region()->points().all();
            told.points = points.size();
            told.kept_points = static_cast<std::uint64_t>(std::ranges::count_if(
                points, [&](const CloudPoint& point) { return !outdated.may_show(point); }));
        } catch (const std::exception& error) {
            told.problem = error.what();
        }
        return told;
    }

    RankLink& link_;
    CloudOptions cloud_;
    const WalkScene& scene_;
    FrameClock clock_;
    std::size_t index_;  ///< of this rank among the workers, the first of which are the owners
    std::optional<FrameLoop> frames_;
};

}  // namespace

void draw_frames(RankLink& link, const CloudOptions& cloud, const WalkScene& scene,
                 Executor& executor, const StopFlag& stop) {
    RankFrameLoop loop(link, cloud, scene);
    const auto next = [&] {
        const TimedActivity waiting(link.timeline(), 0, Activity::wait);
        return link.inbox().next_order(stop);
    };
    while (const std::optional<TracerInbox::Order> order = next())
        std::visit(Overloaded{[&](const FrameOrder& frame) { loop.draw(frame, executor, stop); },
                              [&](const ChangeOrder& change) { loop.follow(change); }},
                   *order);
}

std::vector<std::size_t> owners_beside(const SubImages& parts, std::size_t index, int width,
                                       int height) {
    std::vector<std::size_t> found = parts.overlapping(widened(parts[index], 1, width, height));
    std::erase(found, index);
    return found;
}

}  // namespace lightwalk
