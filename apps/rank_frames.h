#pragma once
// The frames of a walk, drawn by many ranks: rank 0's side.
#include <optional>
#include <string>
#include <vector>

#include "apps/rank_link.h"
#include "parallel/ranks/frame_parts.h"
#include "parallel/walk/frame_lead.h"
#include "parallel/walk/live_frames.h"

namespace lightwalk {

class RankFrames final : public LiveFrames {
  public:
    /// All must outlive this.
    /// @param direct, indirect, cloud, options  see LocalFrames
    /// @param executor  of what rank 0 draws by itself
    RankFrames(RankLink& link, const Tracer& direct, const Tracer* indirect,
               const CloudOptions& cloud, const FrameOptions& options, Executor& executor,
               WarningSink& warnings);

    [[nodiscard]] bool has_indirect() const override { return indirect_ != nullptr; }
    void begin(int width, int height, bool indirect, std::uint64_t first = 0) override;
    [[nodiscard]] WalkFrame draw(const View& view, double budget, double refine,
                                 const StopFlag& stop) override;
    [[nodiscard]] const ProgressivePicture* progressive(const StopFlag& stop) override;
    [[nodiscard]] TracedValues trace(const View& view, const ProgressiveWork& work, double seconds,
                                     const StopFlag& stop) override;
    void add_small_sources(const View& view, Frame& frame) override;
    [[nodiscard]] std::uint64_t rays() const override { return rays_; }

  private:
    [[nodiscard]] std::string payload(const View& view, bool indirect) const;
    [[nodiscard]] std::optional<AssembledFrame> finish(FrameOrder order, const StopFlag& stop);

    RankLink& link_;
    const Tracer& direct_;
    const Tracer* indirect_;
    CloudOptions cloud_;
    FrameOptions options_;
    Executor& executor_;
    WorkerContexts direct_contexts_;
    std::optional<WorkerContexts> indirect_contexts_;
    std::optional<FrameLead> lead_;
    bool walks_by_indirect_ = false;
    struct Last {
        View view;
        CloudFrame frame;
    };
    std::optional<Last> last_;  ///< frame that was drawn
    std::uint64_t rays_ = 0;
};

}  // namespace lightwalk
