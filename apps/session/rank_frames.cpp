#include "apps/session/rank_frames.h"

#include <utility>

#include "apps/session/picture_order.h"

namespace lightwalk {

/// The ranks do so themselves, see ChangeOrder.
double RankFrames::outdate(const ShownMaterials* only) {
    if (only != nullptr && lead_) {
        lead_->abandon();
        return kept_share_;
    }
    start(0);
    return 0;
}

void RankFrames::start(std::uint64_t first) {
    lead_.emplace(options_.width, options_.height, cloud_, first);
    last_.reset();
    (void)mixed();
}

const ProgressivePicture* RankFrames::mixed() {
    if (!lead_) return nullptr;
    if (lead_->mix(mixture_)) return lead_->progressive();
    lead_->abandon();
    return nullptr;
}

void RankFrames::resized() {
    lead_->resize(options_.width, options_.height);
    last_.reset();
}

void RankFrames::put_aside() {
    resting_ = lead_->put_aside();
    rested_ = std::exchange(last_, std::nullopt);
}

void RankFrames::take_back() {
    lead_->take_back(*std::exchange(resting_, std::nullopt));
    last_ = std::exchange(rested_, std::nullopt);
}

std::string RankFrames::payload(const View& view, bool indirect) const {
    PictureOrder picture;
    picture.view = view;
    picture.indirect = indirect;
    return wire::encode(picture);
}

std::optional<AssembledFrame> RankFrames::drawn(FrameOrder order, const StopFlag& stop) {
    std::optional<AssembledFrame> frame = draw_(std::move(order), stop);
    if (frame) rays_ = frame->frame.report.rays;
    return frame;
}

std::optional<KnownPicture> RankFrames::known() const {
    const ProgressivePicture* const picture = lead_ ? lead_->progressive() : nullptr;
    if (picture == nullptr || !last_ || light_groups()) return std::nullopt;
    KnownPicture known{last_->view, options_.width, options_.height, walking_ == indirect_.get()};
    known.values.resize(picture->origins().size());
    for (std::size_t i = 0; i < known.values.size(); ++i) {
        const PixelOrigin::Kind kind = picture->origins()[i].kind;
        if (kind == PixelOrigin::Kind::traced || kind == PixelOrigin::Kind::reused)
            known.values[i] = {picture->radiance()[i], picture->distance()[i]};
    }
    return known;
}

bool RankFrames::recall(const KnownPicture& known, const StopFlag& stop) {
    if (light_groups()) return false;  // what each adds is not known
    const std::optional<AssembledFrame> left = drawn(
        lead_->recall_order(known.values, payload(known.view, walking_ == indirect_.get())), stop);
    if (!left) return false;
    lead_->recalled(left->frame.report.points > 0);
    return left->frame.report.points > 0;
}

WalkFrame RankFrames::draw(const View& view, double budget, double refine, const StopFlag& stop) {
    lead_->set_budget(budget);
    lead_->set_refine(refine);
    const bool rests = lead_->rests(view);
    if (rests) (void)progressive(stop);
    std::optional<AssembledFrame> made =
        drawn(lead_->order(view, payload(view, walking_ == indirect_.get())), stop);
    WalkFrame result;
    if (!made) return result;
    lead_->complete(made->frame, made->refined, executor_, made->refined_groups);
    last_ = Last{view, std::move(made->frame)};
    result.frame = turned_over(last_->frame, executor_);
    result.report = last_->frame.report;
    WorkerContexts& contexts = walking_->contexts;
    contexts.reset_counters();
    draw_small_sources(walking_->tracer, Camera(view), options_, executor_, contexts, result.frame,
                       rests ? cloud_.samples : 0, mixture_);
    result.frame.rays = contexts.rays();
    result.frame.complete = true;
    return result;
}

const ProgressivePicture* RankFrames::progressive(const StopFlag& stop) {
    if (!last_ || !lead_->wants_origins()) return lead_->progressive();
    const std::optional<AssembledFrame> told =
        drawn(lead_->origins_order(payload(last_->view, walking_ == indirect_.get())), stop);
    if (!told) return nullptr;
    lead_->begin_progressive(last_->frame, told->frame.origins);
    return lead_->progressive();
}

TracedValues RankFrames::trace(const View& view, const ProgressiveWork& work, double seconds,
                               const StopFlag& stop) {
    lead_->set_budget(seconds);
    std::optional<AssembledFrame> traced =
        drawn(lead_->trace_order(work, payload(view, true)), stop);
    if (traced) return {std::move(traced->refined), std::move(traced->refined_groups)};
    return std::vector<std::optional<PixelValue>>(work.places.size());
}

}  // namespace lightwalk
