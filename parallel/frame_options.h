#pragma once
// Options of a picture that its renderer and the distribution of its blocks need.
#include <cstdint>
#include <optional>

#include "core/view/pixel_rays.h"
#include "core/view/pixels.h"
#include "core/view/view.h"
#include "parallel/tile_mask.h"

namespace lightwalk {

struct FrameOptions {
    int width = 512, height = 512;  ///< of the whole picture [pixels]
    PixelOptions pixels;
    std::uint64_t seed = 0;
    bool use_distances =
        false;  ///< distances are considered in refinement and in drawing small sources (rpict -z)
    const Camera* previous = nullptr;  ///< view of the frame before, for motion blur
    /// More than 1: trace one pixel of every step x step; the picture is smaller by that factor.
    int step = 1;
    /// The window to render, inside the picture; nothing: all of it. In traced pixels: those of the
    /// smaller picture when `step` is not 1.
    std::optional<PixelRectangle> window;
    /// Where every pixel is traced, the tiles that are: pixels of others are black. Null: all. They
    /// are for a mean of several pictures, and may be negative where the pixels' filter is.
    const TileMask* tiles = nullptr;
    bool hits = false;  ///< whether to return the first hit of each pixel, too

    /// The rectangle of all traced pixels, of every step-th pixel of the picture.
    [[nodiscard]] PixelRectangle whole() const {
        return {0, 0, (width + step - 1) / step, (height + step - 1) / step};
    }
    [[nodiscard]] PixelRectangle area() const { return window.value_or(whole()); }
};

}  // namespace lightwalk
