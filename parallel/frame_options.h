#pragma once
// What a picture is to be: for the renderer of its blocks, and for those who hand them out.
#include <cstdint>
#include <optional>

#include "core/view/pixels.h"
#include "core/view/view.h"
#include "parallel/pixel_rays.h"

namespace lightwalk {

struct FrameOptions {
    int width = 512, height = 512;  ///< of the whole picture [pixels]
    PixelOptions pixels;
    std::uint64_t seed = 0;
    bool use_distances =
        false;  ///< they count in refinement and in drawing small sources (rpict -z)
    const Camera* previous = nullptr;  ///< view of the frame before, for motion blur
    /// More than 1: trace one pixel out of step x step; picture and frame are so much smaller.
    int step = 1;
    /// The part of the picture to make, inside it; nothing: all. In the pixels that are traced, so
    /// of the smaller picture when `step` is not 1.
    std::optional<PixelRectangle> window;
    bool hits = false;  ///< tell what each pixel's ray met, too

    /// All pixels of the picture of every step-th pixel.
    [[nodiscard]] PixelRectangle whole() const {
        return {0, 0, (width + step - 1) / step, (height + step - 1) / step};
    }
    [[nodiscard]] PixelRectangle area() const { return window.value_or(whole()); }
};

}  // namespace lightwalk
