#pragma once
// Frames of a walk that one process draws: each from the points that those before it left, and what
// they cannot answer truthfully is traced.
#include <cstdint>
#include <span>

#include "parallel/walk/frame_lead.h"
#include "parallel/walk/frame_loop.h"

namespace lightwalk {

/// The cloud and its frames. Without a budget a frame is a function of the views so far: the same
/// bytes with any executor. It knows nothing of scenes: whoever can say what a pixel's ray meets
/// can use it.
class CloudFrames {
  public:
    /// @param first  number of the first frame: the audits of frames with the same number choose
    ///               the same pixels
    CloudFrames(int width, int height, const CloudOptions& options, std::uint64_t first = 0)
        : lead_(width, height, options, first), loop_(options) {}

    /// The next frame. Throws what the caster throws; then, and when stopped, the cloud is as it
    /// was before. The frame is there until the next one is drawn.
    [[nodiscard]] const CloudFrame& draw(const Camera& camera, PixelCaster& caster,
                                         Executor& executor, const StopFlag& stop);

    [[nodiscard]] std::span<const CloudPoint> points() const {
        return loop_.region() != nullptr ? loop_.region()->points().all()
                                         : std::span<const CloudPoint>();
    }
    /// The last frame as one to be refined; nothing before the first one, and without `refine`.
    [[nodiscard]] const ProgressivePicture* progressive();
    /// Whether a frame of this view would refine the last one.
    [[nodiscard]] bool refines(const View& view) const { return lead_.rests(view); }
    /// Frames of another size from here on, from the same points. Audits and ages go on.
    void resize(int width, int height) { lead_.resize(width, height); }
    /// See FrameLead.
    [[nodiscard]] FrameLead::Resting put_aside() { return lead_.put_aside(); }
    void take_back(FrameLead::Resting resting) { lead_.take_back(std::move(resting)); }
    void forget_view() { lead_.abandon(); }
    /// Of the light groups in the next frames.
    /// @return  the last frame in this mixture, where it is known of all its pixels and may be
    ///          refined; nothing: the next frame is one of a new view
    [[nodiscard]] const ProgressivePicture* mix(const LightMixture& mixture);
    /// Forget the points that may show some materials; the next frame is one of a new view.
    /// @return  the share of them that are kept, of those that are awake
    double drop(const ShownMaterials& materials) {
        const std::size_t before = points().size();
        loop_.drop(materials);
        lead_.abandon();
        return before > 0 ? static_cast<double>(points().size()) / static_cast<double>(before) : 0;
    }
    /// Time for each of the next frames; 0: none is too long [s].
    void set_budget(double seconds) { lead_.set_budget(seconds); }
    /// Share of the pixels that a frame refines at most; above 0. Choosing them takes time, too.
    void set_refine(double share) { lead_.set_refine(share); }

  private:
    FrameLead lead_;
    FrameLoop loop_;
};

}  // namespace lightwalk
