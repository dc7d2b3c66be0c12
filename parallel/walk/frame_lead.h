#pragma once
// What whoever leads a walk decides from frame to frame, and what it makes of the drawn frames.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/cloud/cloud_frame.h"
#include "core/cloud/progressive.h"
#include "core/cloud/reuse_error_controller.h"
#include "core/view/view.h"
#include "parallel/executor.h"
#include "parallel/walk/frame_order.h"

namespace lightwalk {

class FrameLead {
  public:
    /// @param first  number of the first frame: the audits of frames with the same number choose
    /// the
    ///               same pixels
    FrameLead(int width, int height, const CloudOptions& options, std::uint64_t first);

    /// The next frame. Where its view is that of the last one, begin_progressive() comes before.
    /// @param payload  see FrameOrder
    [[nodiscard]] FrameOrder order(const View& view, std::string payload);
    /// The frame that was ordered is drawn: fills its gaps, or puts what was refined into the
    /// picture of the resting view.
    /// @param refined  values of the order's refined pixels; none: there was no time
    /// @param groups  see TracedValues
    void complete(CloudFrame& frame, std::span<const std::optional<PixelValue>> refined,
                  Executor& executor, std::span<const Rgb> groups = {});
    /// It was not drawn, as somebody stopped it.
    void abandon() { view_.reset(); }

    /// Whether a frame of this view refines the last one, and not only because nothing is known.
    [[nodiscard]] bool rests(const View& view) const { return view_ == view; }
    /// Whether the last frame may be refined but begin_progressive() has not been called.
    [[nodiscard]] bool wants_origins() const { return view_ && !begun_; }
    /// The last frame, and where its pixels come from: only once its view is known to rest, for
    /// copying them takes longer than showing a frame.
    void begin_progressive(const CloudFrame& last, std::span<const PixelOrigin> origins);
    /// The last frame as one to be refined; null where that has not begun.
    [[nodiscard]] const ProgressivePicture* progressive() const {
        return view_ && begun_ ? &progressive_ : nullptr;
    }
    /// Show another mixture of the light groups in it, and in the frames that follow. False: it is
    /// not known of all its pixels.
    [[nodiscard]] bool mix(const LightMixture& mixture);
    /// An order of the last frame's view that draws nothing: parts say where pixels come from.
    [[nodiscard]] FrameOrder origins_order(std::string payload) const;
    /// Pixels of the last frame's view that are no part of the frames, and leave no points.
    [[nodiscard]] FrameOrder trace_order(const ProgressiveWork& work, std::string payload) const;

    /// An order that traces nothing: pixels leave the points of a picture that is known from
    /// elsewhere, of the size of the frames. Only before the first frame.
    [[nodiscard]] FrameOrder recall_order(std::vector<PixelValue> known, std::string payload) const;
    /// It is done.
    /// @param points  whether it has left some
    void recalled(bool points);

    /// Frames of another size follow, from the same points.
    void resize(int width, int height);
    /// What is known of the last frame, so that it may be refined further after frames of other
    /// views and sizes.
    struct Resting {
        int width = 0, height = 0;
        std::optional<View> view;
        bool begun = false;
        ProgressivePicture progressive;
    };
    /// The next frames are of views beside that one (FrameOrder::aside).
    [[nodiscard]] Resting put_aside();
    /// The next frames are of the view that eyes look at again, and of its size.
    void take_back(Resting resting);
    /// Of the frames that follow; see CloudOptions.
    void set_budget(double seconds) { options_.budget = seconds; }
    void set_refine(double share) { options_.refine = share; }

  private:
    [[nodiscard]] FrameOrder new_order(std::string payload) const;
    void refine(CloudFrame& frame, std::span<const std::optional<PixelValue>> refined,
                std::span<const Rgb> groups);

    int width_, height_;
    CloudOptions options_;
    LightMixture mixture_;
    ReuseErrorController error_controller_;
    std::uint64_t frame_;
    std::size_t most_points_;  ///< of the largest frames so far: what they know outlives small ones
    bool aside_ = false;       ///< see put_aside
    bool empty_ = true;        ///< no frame has left points yet
    // The frame that was ordered.
    View ordered_;
    bool rests_ = false;
    ProgressiveWork work_;
    // The last frame, where views that rest are refined.
    std::optional<View> view_;
    bool begun_ = false;  ///< to be refined: what follows is of it
    ProgressivePicture progressive_;
};

}  // namespace lightwalk
