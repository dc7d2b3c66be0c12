#pragma once
// The edge of a set of pixels.
#include <span>
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

/// The outer edge of some pixels, as corners of pixels a step apart, counterclockwise with y up;
/// corner (x, y) is the lower left one of pixel (x, y). Pixels that touch at a corner are
/// connected. A set that is not connected is widened, by the same number of pixels to all sides,
/// until it is; the edge is then that of the widened pixels, and may run outside the picture.
/// @return  the corners, the first not repeated; nothing for no pixels
/// Time: proportional to the area of the pixels' rectangle, times the widening.
[[nodiscard]] std::vector<PixelPlace> pixel_contour(std::span<const PixelPlace> places);

}  // namespace lightwalk
