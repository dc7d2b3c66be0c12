#include "parallel/walk/frame_loop.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "core/error.h"
#include "parallel/executor_task_runner.h"
#include "parallel/sub_images.h"
#include "parallel/walk/step_timer.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMostAsleep = 4'000'000;  ///< points, some 160 MB

}  // namespace

bool FrameLoop::draw(const FrameOrder& order, const Camera& camera, PixelCaster& caster,
                     FrameExchange& exchange, Executor& executor, const StopFlag& stop) {
    using Clock = UncachedPixelTracer::Clock;
    const Clock::time_point deadline =
        order.budget > 0 ? deadline_of(order.budget - infer_seconds_ - keep_seconds_)
                         : Clock::time_point::max();
    begin(order, camera, executor);
    CloudRegion& region = *region_;
    CloudReport& report = region.frame().report;
    if (order.rests) {
        refine(order.refined);
    } else {
        region.project(executor);
        if (!exchange.exchange_points(region, stop)) return false;
        region.answer(caster, executor, stop, checking_deadline(order.budget, unknown_));
        unknown_ = region.unknown();
        if (stop.requested()) return false;
        exchange.send_used(region);
    }
    {
        const StepTimer timer(report.trace_seconds);
        const UncachedPixelTracer tracer(
            caster, options_.tolerance, tracing_deadline(deadline, order.budget, region.unknown()));
        if (!exchange.trace(region, tracer, order.sample, executor, stop)) return false;
    }
    if (!order.rests) {
        region.show(order.budget > 0);
        region.infer(caster, executor, stop, inferring_deadline(order.budget));
    }
    const AgeCounts ages = order.rests ? region.rest(order.leaves) : region.age(executor);
    report.points = std::accumulate(ages.begin(), ages.end(), std::size_t{0});
    exchange.deliver(order, region);
    const std::optional<AgeCounts> all = exchange.sum(ages);
    if (!all) return false;
    region.keep(age_limit(*all, order.most_points), executor);
    region.points().limit_asleep(std::min(order.most_points, kMostAsleep) / owners_);
    keep_seconds_ = report.keep_seconds;
    infer_seconds_ = report.infer_seconds;
    return true;
}

void FrameLoop::begin(const FrameOrder& order, const Camera& camera, Executor& executor) {
    constexpr int kMostPixels = 1 << 16;  // in a row or column
    if (order.width < 1 || order.width > kMostPixels || order.height < 1 ||
        order.height > kMostPixels)
        throw InputError("a frame of a walk is ordered in a size that cannot be");
    const bool same = region_ && width_ == order.width && height_ == order.height;
    width_ = order.width;
    height_ = order.height;
    if (!same || order.rules.empty) {
        // Points are places in the scene: in a picture of another size they answer other pixels.
        std::optional<CloudRegion> before = std::exchange(region_, std::nullopt);
        const SubImages parts({0, 0, width_, height_}, owners_);
        region_.emplace(parts[index_], width_, height_, options_);
        if (before && !order.rules.empty) region_->points().adopt(std::move(before->points()));
    }
    region_->points().mix(order.mixture, ExecutorTaskRunner(executor));
    region_->begin(camera, order.rules);
}

/// The view stands still: the order says what is to be traced.
void FrameLoop::refine(std::span<const PixelPlace> places) {
    const StepTimer timer(region_->frame().report.check_seconds);
    std::vector<PixelPlace> own;
    for (const PixelPlace& place : places)
        if (region_->frame().area.contains(place)) own.push_back(place);
    region_->refine(own);
}

bool NoFrameExchange::trace(CloudRegion& region, const UncachedPixelTracer& tracer, int sample,
                            Executor& executor, const StopFlag& stop) {
    TraceList& to_trace = region.to_trace();
    const std::vector<PixelPlace> places = to_trace.places();
    const std::size_t own = places.size() - to_trace.noise_pairs();
    const auto trace = [&](std::size_t begin, std::size_t count, int by_sample) {
        tracer.trace(std::span(places).subspan(begin, count), by_sample, executor, stop,
                     [&](std::size_t first, const TracedPixels& traced) {
                         to_trace.record(begin + first, traced.results, traced.groups,
                                         traced.ahead);
                     });
    };
    trace(0, own, sample);
    trace(own, to_trace.noise_pairs(), 1);
    return !stop.requested();
}

}  // namespace lightwalk
