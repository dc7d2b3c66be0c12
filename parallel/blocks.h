#pragma once
// Rectangles of pixels: the unit of work that is handed out.
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

using Block = PixelRectangle;  ///< a rectangle in its role as a unit of work

/// Side of square blocks: a multiple of `alignment` (>= 1), at most 64 or `alignment`, small enough
/// that each of `workers` gets about 32 blocks to even out their cost, where there are that many
/// pixels.
[[nodiscard]] int block_side(int width, int height, int workers, int alignment);

/// All blocks of a width x height picture with corners at multiples of `side`; those at the right
/// and upper edge may be smaller. In stride order: consecutive blocks lie far apart, so that a
/// costly region is shared out and what is done early covers the picture evenly.
[[nodiscard]] std::vector<Block> make_blocks(int width, int height, int side);

}  // namespace lightwalk
