#include "parallel/walk/frame_lead.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cloud/gaps.h"

namespace lightwalk {

FrameLead::FrameLead(int width, int height, const CloudOptions& options, std::uint64_t first)
    : width_(width),
      height_(height),
      options_(options),
      error_controller_(options.audit_limit),
      frame_(first),
      progressive_(width, height, options.samples) {}

FrameOrder FrameLead::new_order(std::string payload) const {
    FrameOrder order;
    order.width = width_;
    order.height = height_;
    order.rules = {frame_, empty_, error_controller_.tightness()};
    order.payload = std::move(payload);
    order.budget = options_.budget;
    return order;
}

FrameOrder FrameLead::order(const View& view, std::string payload) {
    FrameOrder order = new_order(std::move(payload));
    ordered_ = view;
    rests_ = begun_ && rests(view);
    work_ = {};
    if (rests_) {
        const double pixels = static_cast<double>(width_) * static_cast<double>(height_);
        work_ = progressive_.next(static_cast<std::size_t>(std::ceil(options_.refine * pixels)));
    }
    order.rests = rests_;
    order.leaves = rests_ && work_.sample == 0;
    order.sample = work_.sample;
    order.refined = work_.places;
    return order;
}

FrameOrder FrameLead::origins_order(std::string payload) const {
    FrameOrder order = new_order(std::move(payload));
    order.rests = order.tells_origins = true;
    return order;
}

FrameOrder FrameLead::trace_order(const ProgressiveWork& work, std::string payload) const {
    FrameOrder order = new_order(std::move(payload));
    order.rests = true;
    order.sample = work.sample;
    order.refined = work.places;
    return order;
}

void FrameLead::begin_progressive(const CloudFrame& last, std::span<const PixelOrigin> origins) {
    progressive_.begin(last.radiance, origins);
    distance_ = last.distance;
    begun_ = true;
}

void FrameLead::complete(CloudFrame& frame, std::span<const std::uint8_t> known,
                         std::span<const std::optional<PixelValue>> refined, Executor& executor) {
    empty_ = frame.report.points == 0;
    if (rests_) {
        refine(frame, refined);
    } else {
        error_controller_.record(frame.report.audit_errors, frame.report.audit_floors);
        if (frame.report.filled > 0) fill(frame, known, executor);
        if (options_.refine > 0) view_ = ordered_;
        begun_ = false;
    }
    ++frame_;
    frame.complete = true;
}

/// Pixels that there was no time for, from what lies around them.
void FrameLead::fill(CloudFrame& frame, std::span<const std::uint8_t> known,
                     Executor& executor) const {
    const auto by_rows = [&](int rows, FunctionRef<void(int, int)> part) {
        constexpr int kRowsATask = 32;
        const int tasks = (rows + kRowsATask - 1) / kRowsATask;
        executor.for_each(static_cast<std::size_t>(tasks), [&](std::size_t task, int) {
            const int first = static_cast<int>(task) * kRowsATask;
            part(first, std::min(first + kRowsATask, rows));
        });
    };
    fill_gaps(width_, height_, frame.radiance, known, by_rows);
}

/// Put what was traced into the picture of a resting view.
void FrameLead::refine(CloudFrame& frame, std::span<const std::optional<PixelValue>> refined) {
    ProgressiveWork done{work_.sample, {}};
    std::vector<Rgb> radiance;
    for (std::size_t i = 0; i < refined.size(); ++i) {
        if (!refined[i]) continue;
        const PixelPlace& place = work_.places[i];
        done.places.push_back(place);
        radiance.push_back(refined[i]->radiance);
        if (!frame.causes.empty()) frame.causes[pixel(place)] = TraceCause::refined;
        if (work_.sample == 0) distance_[pixel(place)] = refined[i]->distance;
    }
    progressive_.record(done, radiance);
    frame.radiance = progressive_.picture();
    frame.distance = distance_;
    frame.report.uncached[static_cast<std::size_t>(TraceCause::refined)] = radiance.size();
    frame.report.filled = progressive_.guessed_pixels();
    frame.report.reused = frame.report.pixels - frame.report.filled;
}

}  // namespace lightwalk
