#pragma once
// The frames of a walk, drawn by many ranks: rank 0's side.
#include <functional>
#include <optional>
#include <string>

#include "parallel/ranks/assembly.h"
#include "parallel/walk/frame_lead.h"
#include "parallel/walk/live_frames.h"

namespace lightwalk {

class RankFrames final : public LiveFrames {
  public:
    /// Has all ranks draw a frame; nothing: stopped.
    using Draw =
        std::function<std::optional<AssembledFrame>(FrameOrder order, const StopFlag& stop)>;
    /// Further parameters as of LiveFrames; the executor is for what rank 0 draws by itself.
    RankFrames(Draw draw, const Tracer& direct, const Tracer* indirect, const CloudOptions& cloud,
               const FrameOptions& options, Executor& executor, WarningSink& warnings)
        : LiveFrames(direct, indirect, cloud, options, executor, warnings),
          draw_(std::move(draw)) {}

    /// Share of the points that ranks keep at the next change(), where it keeps some.
    void set_kept(double share) { kept_share_ = share; }
    void forget_view() override { lead_->abandon(); }
    [[nodiscard]] std::optional<KnownPicture> known() const override;
    [[nodiscard]] bool recall(const KnownPicture& known, const StopFlag& stop) override;
    [[nodiscard]] WalkFrame draw(const View& view, double budget, double refine,
                                 const StopFlag& stop) override;
    [[nodiscard]] const ProgressivePicture* progressive(const StopFlag& stop) override;
    [[nodiscard]] TracedValues trace(const View& view, const ProgressiveWork& work, double seconds,
                                     const StopFlag& stop) override;

  private:
    double outdate(const ShownMaterials* only) override;
    void start(std::uint64_t first) override;
    void resized() override;
    void put_aside() override;
    void take_back() override;
    [[nodiscard]] const ProgressivePicture* mixed() override;
    [[nodiscard]] std::string payload(const View& view, bool indirect) const;
    [[nodiscard]] std::optional<AssembledFrame> drawn(FrameOrder order, const StopFlag& stop);

    Draw draw_;
    std::optional<FrameLead> lead_;
    double kept_share_ = 0;  ///< see set_kept
    struct Last {
        View view;
        CloudFrame frame;
    };
    std::optional<Last> last_;                   ///< frame that was drawn
    std::optional<FrameLead::Resting> resting_;  ///< that was put aside
    std::optional<Last> rested_;                 ///< the same
};

}  // namespace lightwalk
