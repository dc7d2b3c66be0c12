#pragma once
// The frames of a walk that somebody steers, drawn by many ranks: rank 0's side.
#include <optional>
#include <string>
#include <vector>

#include "apps/rank_link.h"
#include "parallel/ranks/cloud_lead.h"
#include "parallel/walk/live_frames.h"

namespace lightwalk {

class RankFrames final : public LiveFrames {
  public:
    /// All must outlive this.
    /// @param direct, indirect, cloud, options  see LocalFrames
    /// @param executor  of what rank 0 draws by itself
    /// @param first     number of the first order: greater than that of any before
    RankFrames(RankLink& link, const Tracer& direct, const Tracer* indirect,
               const CloudOptions& cloud, const FrameOptions& options, Executor& executor,
               WarningSink& warnings, WalkFrameId first);

    [[nodiscard]] bool has_indirect() const override { return indirect_ != nullptr; }
    void begin(int width, int height, bool indirect) override;
    [[nodiscard]] WalkFrame draw(const View& view, double budget, double refine,
                                 const StopFlag& stop) override;
    [[nodiscard]] const ProgressivePicture* progressive(const StopFlag& stop) override;
    [[nodiscard]] std::vector<PixelValue> trace(const View& view, const ProgressiveWork& work,
                                                double seconds, const StopFlag& stop) override;
    void add_small_sources(const View& view, Frame& frame) override;
    [[nodiscard]] std::uint64_t rays() const override { return rays_; }

    /// Number of the next order.
    [[nodiscard]] WalkFrameId next() const { return lead_ ? lead_->next() : first_; }

  private:
    [[nodiscard]] std::string payload(const View& view, bool indirect) const;
    [[nodiscard]] std::optional<FinishedFrame> finish(CloudOrder order, const StopFlag& stop);
    void add_small_sources(const View& view, const Tracer& tracer, WorkerContexts& contexts,
                           Frame& frame);

    RankLink& link_;
    const Tracer& direct_;
    const Tracer* indirect_;
    CloudOptions cloud_;
    FrameOptions options_;
    Executor& executor_;
    WorkerContexts direct_contexts_;
    std::optional<WorkerContexts> indirect_contexts_;
    WalkFrameId first_;
    std::optional<CloudLead> lead_;
    bool walks_by_indirect_ = false;
    std::optional<View> view_;  ///< of the last frame
    std::uint64_t rays_ = 0;
};

}  // namespace lightwalk
