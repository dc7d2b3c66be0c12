#include "parallel/walk/frame_lead.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cloud/gaps.h"
#include "parallel/executor_task_runner.h"

namespace lightwalk {

FrameLead::FrameLead(int width, int height, const CloudOptions& options, std::uint64_t first)
    : width_(width),
      height_(height),
      options_(options),
      error_controller_(options.audit_limit),
      frame_(first),
      most_points_(options.most_points(width, height)),
      progressive_(width, height, options.samples) {}

void FrameLead::resize(int width, int height) {
    if (width_ == width && height_ == height) return;
    width_ = width;
    height_ = height;
    most_points_ = std::max(most_points_, options_.most_points(width, height));
    progressive_ = ProgressivePicture(width, height, options_.samples);
    view_.reset();
    begun_ = false;
}

FrameLead::Resting FrameLead::put_aside() {
    Resting resting{width_, height_, view_, begun_, std::move(progressive_)};
    progressive_ = ProgressivePicture(width_, height_, options_.samples);
    view_.reset();
    begun_ = false;
    aside_ = true;
    return resting;
}

void FrameLead::take_back(Resting resting) {
    width_ = resting.width;
    height_ = resting.height;
    view_ = resting.view;
    begun_ = resting.begun;
    progressive_ = std::move(resting.progressive);
    aside_ = false;
}

FrameOrder FrameLead::new_order(std::string payload) const {
    FrameOrder order;
    order.width = width_;
    order.height = height_;
    order.rules = {frame_, empty_, error_controller_.tightness()};
    order.payload = std::move(payload);
    order.budget = options_.budget;
    order.most_points = most_points_;
    order.mixture = mixture_;
    order.aside = aside_;
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

FrameOrder FrameLead::recall_order(std::vector<PixelValue> known, std::string payload) const {
    FrameOrder order = new_order(std::move(payload));
    order.rests = order.leaves = true;
    order.known = std::move(known);
    return order;
}

void FrameLead::recalled(bool points) {
    empty_ = !points;
    ++frame_;
}

void FrameLead::begin_progressive(const CloudFrame& last, std::span<const PixelOrigin> origins) {
    progressive_.begin(last.radiance, last.distance, origins);
    begun_ = true;
}

bool FrameLead::mix(const LightMixture& mixture) {
    mixture_ = mixture;
    if (progressive() == nullptr || !progressive_.knows_groups()) return false;
    progressive_.mix(mixture);
    return true;
}

void FrameLead::complete(CloudFrame& frame, std::span<const std::optional<PixelValue>> refined,
                         Executor& executor, std::span<const Rgb> groups) {
    empty_ = frame.report.points == 0;
    if (rests_) {
        refine(frame, refined, groups);
    } else {
        error_controller_.record(frame.report.audit_errors, frame.report.audit_floors);
        // Pixels that there was no time for, from what lies around them.
        if (frame.report.filled > 0)
            fill_gaps(width_, height_, frame.radiance, frame.known, ExecutorTaskRunner(executor));
        if (options_.refine > 0) view_ = ordered_;
        begun_ = false;
    }
    ++frame_;
    frame.complete = true;
}

/// Put what was traced into the picture of a resting view.
void FrameLead::refine(CloudFrame& frame, std::span<const std::optional<PixelValue>> refined,
                       std::span<const Rgb> groups) {
    progressive_.record(work_, refined, groups);
    const std::span<const float> distance = progressive_.distance();
    frame.radiance = progressive_.picture();
    frame.distance.assign(distance.begin(), distance.end());
    std::size_t traced = 0;
    for (std::size_t i = 0; i < refined.size(); ++i) {
        if (!refined[i]) continue;
        ++traced;
        if (!frame.causes.empty())
            frame.causes[frame.area.index(work_.places[i])] = TraceCause::refined;
    }
    frame.report.uncached[static_cast<std::size_t>(TraceCause::refined)] = traced;
    frame.report.filled = progressive_.guessed_pixels();
    frame.report.reused = frame.report.pixels - frame.report.filled;
}

}  // namespace lightwalk
