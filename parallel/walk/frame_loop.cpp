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
    Frames& frames = of(order);
    const Clock::time_point deadline =
        order.budget > 0 ? clock_.in(order.budget - frames.infer_seconds - frames.keep_seconds)
                         : Clock::time_point::max();
    begin(order, camera, executor);
    CloudRegion& region = *frames.region;
    CloudReport& report = region.frame().report;
    if (order.rests) {
        refine(region, order.refined);
        if (!order.known.empty()) region.recall(order.known, caster, executor);
    } else {
        region.project(executor);
        if (!exchange.exchange_points(region, stop)) return false;
        region.answer(caster, executor, stop,
                      checking_deadline(clock_, order.budget, frames.unknown));
        frames.unknown = region.unknown();
        if (stop.requested()) return false;
        exchange.send_used(region);
    }
    {
        const StepTimer timer(report.trace_seconds, clock_);
        const UncachedPixelTracer tracer(
            caster, options_.tolerance,
            tracing_deadline(clock_, deadline, order.budget, region.unknown()), clock_);
        if (!exchange.trace(region, tracer, order.sample, executor, stop)) return false;
    }
    if (!order.rests) {
        region.show(order.budget > 0);
        region.infer(caster, executor, stop, inferring_deadline(clock_, order.budget));
    }
    const AgeCounts ages = order.rests ? region.rest(order.leaves) : region.age(executor);
    report.points = std::accumulate(ages.begin(), ages.end(), std::size_t{0});
    exchange.deliver(order, region);
    const std::optional<AgeCounts> all = exchange.sum(ages);
    if (!all) return false;
    region.keep(age_limit(*all, order.most_points), executor);
    region.points().limit_asleep(std::min(order.most_points, kMostAsleep) / owners_);
    frames.keep_seconds = report.keep_seconds;
    frames.infer_seconds = report.infer_seconds;
    return true;
}

void FrameLoop::begin(const FrameOrder& order, const Camera& camera, Executor& executor) {
    constexpr int kMostPixels = 1 << 16;  // in a row or column
    if (order.width < 1 || order.width > kMostPixels || order.height < 1 ||
        order.height > kMostPixels)
        throw InputError("a frame of a walk is ordered in a size that cannot be");
    if (!order.aside || aside_.view != camera.view()) put_aside_to_sleep();
    Frames& frames = of(order);
    const bool same = frames.region && frames.width == order.width && frames.height == order.height;
    frames.view = camera.view();
    frames.width = order.width;
    frames.height = order.height;
    // A view that rests goes on with what is known of its pixels, also where they left no points.
    const bool anew = order.rules.empty && !order.rests;
    if (!same || anew) {
        // Points are places in the scene: in a picture of another size they answer other pixels.
        std::optional<CloudRegion> before = std::exchange(frames.region, std::nullopt);
        const SubImages parts({0, 0, order.width, order.height}, owners_);
        frames.region.emplace(parts[index_], order.width, order.height, options_, clock_);
        if (before && !anew) frames.region->points().adopt(std::move(before->points()));
    }
    frames.region->points().mix(order.mixture, ExecutorTaskRunner(executor));
    frames.region->begin(camera, order.rules);
}

void FrameLoop::put_aside_to_sleep() {
    if (aside_.region && shown_.region)
        shown_.region->points().take_asleep(aside_.region->points());
    aside_.forget();
}

/// The view stands still: the order says what is to be traced.
void FrameLoop::refine(CloudRegion& region, std::span<const PixelPlace> places) const {
    const StepTimer timer(region.frame().report.check_seconds, clock_);
    std::vector<PixelPlace> own;
    for (const PixelPlace& place : places)
        if (region.frame().area.contains(place)) own.push_back(place);
    region.refine(own);
}

bool trace_alone(CloudRegion& region, const UncachedPixelTracer& tracer, int sample,
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
