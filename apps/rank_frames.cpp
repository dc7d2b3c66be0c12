#include "apps/rank_frames.h"

#include <utility>

#include "apps/rank_pictures.h"

namespace lightwalk {

RankFrames::RankFrames(RankLink& link, const Tracer& direct, const Tracer* indirect,
                       const CloudOptions& cloud, const FrameOptions& options, Executor& executor,
                       WarningSink& warnings)
    : link_(link),
      direct_(direct),
      indirect_(indirect),
      cloud_(cloud),
      options_(options),
      executor_(executor),
      direct_contexts_(direct, warnings, executor.concurrency()) {
    if (indirect != nullptr)
        indirect_contexts_.emplace(*indirect, warnings, executor.concurrency());
}

void RankFrames::begin(int width, int height, bool indirect, std::uint64_t first) {
    options_.width = width;
    options_.height = height;
    walks_by_indirect_ = indirect;
    lead_.emplace(width, height, cloud_, first);
    last_.reset();
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
std::optional<AssembledFrame> RankFrames::finish(FrameOrder order, const StopFlag& stop) {
    link_.submit(order);
    const std::optional<FinishedFrame> finished = link_.wait_for_frame(stop);
    if (!finished) return std::nullopt;
    AssembledFrame frame =
        assemble_frame(order, *finished, cloud_.most_points(order.width, order.height));
    rays_ = frame.frame.report.rays;
    return frame;
}

WalkFrame RankFrames::draw(const View& view, double budget, double refine, const StopFlag& stop) {
    lead_->set_budget(budget);
    lead_->set_refine(refine);
    if (lead_->rests(view)) (void)progressive(stop);
    std::optional<AssembledFrame> drawn =
        finish(lead_->order(view, payload(view, walks_by_indirect_)), stop);
    WalkFrame result;
    if (!drawn) return result;
    lead_->complete(drawn->frame, drawn->refined, executor_);
    last_ = Last{view, std::move(drawn->frame)};
    result.frame = turned_over(last_->frame, executor_);
    result.report = last_->frame.report;
    WorkerContexts& contexts = walks_by_indirect_ ? *indirect_contexts_ : direct_contexts_;
    contexts.reset_counters();
    draw_small_sources(walks_by_indirect_ ? *indirect_ : direct_, Camera(view), options_, executor_,
                       contexts, result.frame);
    result.frame.rays = contexts.rays();
    result.frame.complete = true;
    return result;
}

const ProgressivePicture* RankFrames::progressive(const StopFlag& stop) {
    if (!last_ || !lead_->wants_origins()) return lead_->progressive();
    const std::optional<AssembledFrame> told =
        finish(lead_->origins_order(payload(last_->view, walks_by_indirect_)), stop);
    if (!told) return nullptr;
    lead_->begin_progressive(last_->frame, told->frame.origins);
    return lead_->progressive();
}

TracedValues RankFrames::trace(const View& view, const ProgressiveWork& work, double seconds,
                               const StopFlag& stop) {
    lead_->set_budget(seconds);
    std::optional<AssembledFrame> traced =
        finish(lead_->trace_order(work, payload(view, true)), stop);
    return traced ? std::move(traced->refined) : TracedValues(work.places.size());
}

void RankFrames::add_small_sources(const View& view, Frame& frame) {
    draw_small_sources(*indirect_, Camera(view), options_, executor_, *indirect_contexts_, frame);
}

}  // namespace lightwalk
