#include "parallel/walk/cloud_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cloud/gaps.h"
#include "parallel/walk/step_timer.h"
#include "parallel/walk/uncached_pixel_tracer.h"

namespace lightwalk {
/// One frame on its way.
struct CloudFrames::Step {
    const PixelCaster& caster;
    Executor& executor;
    const StopFlag& stop;
    UncachedPixelTracer::Clock::time_point deadline;
    ProgressiveWork work;  ///< what the uncached pixels of a progressive view are
};

CloudFrames::CloudFrames(int width, int height, const CloudOptions& options, std::uint64_t first)
    : width_(width),
      height_(height),
      options_(options),
      region_({0, 0, width, height}, width, height, options),
      error_controller_(options.audit_limit),
      frame_(first),
      progressive_(width, height, options.samples) {}

const CloudFrame& CloudFrames::draw(const Camera& camera, const PixelCaster& caster,
                                    Executor& executor, const StopFlag& stop) {
    Step step{caster, executor, stop, UncachedPixelTracer::Clock::time_point::max(), {}};
    if (options_.budget > 0) step.deadline = deadline_of(options_.budget - last_keep_seconds_);
    const bool rests = view_ == camera.view();
    if (rests) begin_progressive();  // before the last frame is forgotten
    region_.begin(camera, {frame_, region_.points().empty(), error_controller_.tightness(), {}});
    if (rests) {
        plan_refinement(step);
    } else {
        region_.project(executor);
        region_.answer(caster, executor, stop, checking_deadline(options_.budget));
    }
    trace(step);
    CloudFrame& frame = region_.frame();
    if (stop.requested()) {
        view_.reset();
        return frame;
    }
    if (rests)
        refine(step);
    else
        show(executor);
    if (!rests && options_.refine > 0) {
        view_ = camera.view();
        begun_ = false;
    }
    const AgeCounts ages = rests ? region_.rest(step.work.sample == 0) : region_.age(executor);
    region_.keep(age_limit(ages, options_.most_points(width_, height_)), executor);
    last_keep_seconds_ = frame.report.keep_seconds;
    ++frame_;
    frame.complete = true;
    return frame;
}

const ProgressivePicture* CloudFrames::progressive() {
    if (!view_) return nullptr;
    begin_progressive();
    return &progressive_;
}

/// Only once it is known that the view rests: the copies take longer than showing a frame.
void CloudFrames::begin_progressive() {
    if (begun_) return;
    progressive_.begin(region_.frame().radiance, region_.origins());
    distance_ = region_.frame().distance;
    begun_ = true;
}

/// The view stands still: nothing is missing, but there are better values than those that it shows.
void CloudFrames::plan_refinement(Step& step) {
    CloudReport& report = region_.frame().report;
    const StepTimer timer(report.check_seconds);
    const auto most =
        static_cast<std::size_t>(std::ceil(options_.refine * static_cast<double>(report.pixels)));
    step.work = progressive_.next(most);
    region_.refine(step.work.places);
}

/// Trace uncached pixels until the frame's time is over; some at least, or a short budget would
/// never end.
void CloudFrames::trace(Step& step) {
    const StepTimer timer(region_.frame().report.trace_seconds);
    const UncachedPixelTracer tracer(
        step.caster, options_.tolerance,
        tracing_deadline(step.deadline, options_.budget, region_.unknown()));
    const std::span<const UncachedPixel> uncached = region_.uncached();
    tracer.trace(
        uncached.size(), [&](std::size_t uncached_pixel) { return uncached[uncached_pixel].place; },
        step.work.sample, step.executor, step.stop,
        [&](std::size_t first, std::span<const TracedPixelResult> traced) {
            region_.record(first, traced);
        });
    const std::span<const std::uint32_t> noise_pairs = region_.noise_pairs();
    tracer.trace(
        noise_pairs.size(), [&](std::size_t pair) { return uncached[noise_pairs[pair]].place; }, 1,
        step.executor, step.stop,
        [&](std::size_t first, std::span<const TracedPixelResult> traced) {
            region_.record_noise_pairs(first, traced);
        });
}

void CloudFrames::show(Executor& executor) {
    region_.show();
    const CloudReport& report = region_.frame().report;
    error_controller_.record(report.audit_errors, report.audit_floors);
    // Holes that there was no time for, from what lies around them.
    if (report.filled == 0) return;
    const auto by_rows = [&](int rows, FunctionRef<void(int, int)> part) {
        constexpr int kRowsATask = 32;
        const int tasks = (rows + kRowsATask - 1) / kRowsATask;
        executor.for_each(static_cast<std::size_t>(tasks), [&](std::size_t task, int) {
            const int first = static_cast<int>(task) * kRowsATask;
            part(first, std::min(first + kRowsATask, rows));
        });
    };
    fill_gaps(width_, height_, region_.frame().radiance, region_.known(), by_rows);
}

/// Put what was traced into the picture of a progressive view.
void CloudFrames::refine(Step& step) {
    CloudFrame& frame = region_.frame();
    ProgressiveWork done{step.work.sample, {}};
    std::vector<Rgb> radiance;
    for (std::size_t i = 0; i < region_.uncached().size(); ++i) {
        if (!region_.is_traced(i)) continue;
        const PixelPlace& place = region_.uncached()[i].place;
        const PixelValue& traced = region_.traced(i).value;
        done.places.push_back(place);
        radiance.push_back(traced.radiance);
        frame.causes[region_.pixel(place)] = TraceCause::refined;
        if (step.work.sample == 0) distance_[region_.pixel(place)] = traced.distance;
    }
    progressive_.record(done, radiance);
    frame.radiance = progressive_.picture();
    frame.distance = distance_;
    frame.report.uncached[static_cast<std::size_t>(TraceCause::refined)] = radiance.size();
    frame.report.filled = progressive_.guessed_pixels();
    frame.report.reused = frame.report.pixels - frame.report.filled;
}

}  // namespace lightwalk
