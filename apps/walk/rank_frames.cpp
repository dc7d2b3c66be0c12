#include "apps/walk/rank_frames.h"

#include <utility>

#include "apps/rank_pictures.h"

namespace lightwalk {

RankFrames::RankFrames(RankLink& link, const Tracer& direct, const Tracer* indirect,
                       const CloudOptions& cloud, const FrameOptions& options, Executor& executor,
                       WarningSink& warnings, WalkFrameId first)
    : link_(link),
      direct_(direct),
      indirect_(indirect),
      cloud_(cloud),
      options_(options),
      executor_(executor),
      direct_contexts_(direct, warnings, executor.concurrency()),
      first_(first) {
    if (indirect != nullptr)
        indirect_contexts_.emplace(*indirect, warnings, executor.concurrency());
}

void RankFrames::begin(int width, int height, bool indirect) {
    options_.width = width;
    options_.height = height;
    walks_by_indirect_ = indirect;
    const WalkFrameId number = next();
    lead_.emplace(width, height, cloud_, number);
    view_.reset();
}

std::string RankFrames::payload(const View& view, bool indirect) const {
    PictureOrder picture;
    picture.view = view;
    picture.width = options_.width;
    picture.height = options_.height;
    picture.indirect = indirect;
    return encode_order(picture);
}

/// Nothing: stopped.
std::optional<FinishedFrame> RankFrames::finish(CloudOrder order, const StopFlag& stop) {
    link_.submit(std::move(order));
    std::optional<FinishedFrame> finished = link_.wait_for_frame(stop);
    if (!finished) return std::nullopt;
    rays_ = 0;
    for (const CloudPart& part : finished->parts) rays_ += part.report.rays;
    return finished;
}

WalkFrame RankFrames::draw(const View& view, double budget, double refine, const StopFlag& stop) {
    lead_->set_limits(budget, refine);
    const std::optional<FinishedFrame> finished =
        finish(lead_->order(view, nullptr, payload(view, walks_by_indirect_)), stop);
    WalkFrame result;
    if (!finished) return result;
    CloudFrame drawn = lead_->take(*finished);
    view_ = view;
    result.frame = turned_over(drawn, options_.width, options_.height);
    result.report = std::move(drawn.report);
    if (walks_by_indirect_)
        add_small_sources(view, result.frame);
    else
        add_small_sources(view, direct_, direct_contexts_, result.frame);
    result.frame.complete = true;
    return result;
}

const ProgressivePicture* RankFrames::progressive(const StopFlag& stop) {
    if (!view_ || lead_->progressive() != nullptr) return view_ ? lead_->progressive() : nullptr;
    const std::optional<FinishedFrame> finished =
        finish(lead_->ask_origins(payload(*view_, walks_by_indirect_)), stop);
    if (!finished) return nullptr;
    lead_->take_origins(*finished);
    return lead_->progressive();
}

std::vector<PixelValue> RankFrames::trace(const View& view, const ProgressiveWork& work,
                                          double seconds, const StopFlag& stop) {
    lead_->set_limits(seconds, cloud_.refine);
    const std::optional<FinishedFrame> finished =
        finish(lead_->trace(work, payload(view, true)), stop);
    if (!finished) return std::vector<PixelValue>(work.places.size(), {{}, -1});
    return lead_->take_traced(*finished);
}

void RankFrames::add_small_sources(const View& view, Frame& frame) {
    add_small_sources(view, *indirect_, *indirect_contexts_, frame);
}

void RankFrames::add_small_sources(const View& view, const Tracer& tracer, WorkerContexts& contexts,
                                   Frame& frame) {
    draw_small_sources(tracer, Camera(view), options_, executor_, contexts, frame);
}

}  // namespace lightwalk
