#pragma once
// What rank 0 decides from frame to frame of a walk that ranks draw together, and what it makes of
// their parts.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/cloud/progressive.h"
#include "core/cloud/reuse_error_controller.h"
#include "core/view/view.h"
#include "parallel/ranks/cloud_messages.h"
#include "parallel/walk/cloud_frame.h"

namespace lightwalk {

class CloudLead {
  public:
    /// @param first  number of the first frame
    CloudLead(int width, int height, const CloudOptions& options, WalkFrameId first);

    /// Of the next frame.
    /// @param next     view of the one after it; null: nobody knows
    /// @param payload  see CloudOrder
    [[nodiscard]] CloudOrder order(const View& view, const View* next, std::string payload);

    /// The frame that was ordered: that of one process. In its report seconds are those of the
    /// slowest rank in each step; the points are those that there is room for, of which a few less
    /// are kept where there was too little (see age_limit). It says of no pixel why it was traced.
    /// Throws InputError for parts that do not make the frame.
    [[nodiscard]] CloudFrame take(const FinishedFrame& finished);

    // Of walks whose next view nobody knows: orders of the view of the last frame.

    /// Of the frames that follow; see CloudOptions.
    void set_limits(double budget, double refine) {
        options_.budget = budget;
        options_.refine = refine;
    }
    /// The last frame is kept, to be refined where the next one turns out to have the same view:
    /// once it is known where its pixels come from.
    [[nodiscard]] CloudOrder ask_origins(std::string payload);
    void take_origins(const FinishedFrame& finished);
    /// The last frame's pixels as far as that is known; else null.
    [[nodiscard]] const ProgressivePicture* progressive() const {
        return progressive_view_ ? &progressive_ : nullptr;
    }
    /// Pixels that are no part of the frames, and leave no points.
    [[nodiscard]] CloudOrder trace(const ProgressiveWork& work, std::string payload);
    /// The distance of those that there was no time for is negative.
    [[nodiscard]] std::vector<PixelValue> take_traced(const FinishedFrame& finished);
    /// Number of the next order.
    [[nodiscard]] WalkFrameId next() const { return frame_; }

  private:
    [[nodiscard]] CloudOrder new_order(std::string payload) const;
    [[nodiscard]] std::vector<PixelValue> refined_values(
        std::span<const CloudPart* const> parts) const;
    [[nodiscard]] std::vector<const CloudPart*> sorted_parts(const FinishedFrame& finished) const;
    void add_up(std::span<const CloudPart* const> parts, CloudReport& report);
    void put_together(std::span<const CloudPart* const> parts, CloudFrame& frame) const;
    void remember(std::span<const CloudPart* const> parts, std::span<const Rgb> radiance);
    void refine(std::span<const CloudPart* const> parts, CloudFrame& frame);
    /// Calls visit(index of the pixel in the picture, index in the part).
    template <class Visit>
    void for_pixels(const PixelRectangle& area, Visit visit) const {
        std::size_t in_part = 0;
        for (int y = area.y0; y < area.y1; ++y)
            for (int x = area.x0; x < area.x1; ++x, ++in_part)
                visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                          static_cast<std::size_t>(x),
                      in_part);
    }

    int width_, height_;
    CloudOptions options_;
    ReuseErrorController error_controller_;
    WalkFrameId frame_;
    bool empty_ = true;
    AgeLimit room_;
    // The frame that was ordered.
    std::optional<View> view_;
    bool rests_ = false, rest_follows_ = false;
    ProgressiveWork work_;
    // Of a view that rests.
    std::optional<View> progressive_view_;
    ProgressivePicture progressive_;
    std::vector<Rgb> radiance_;  ///< of the last frame, in case it rests
    std::vector<float> distance_;
};

}  // namespace lightwalk
