#pragma once
// Blocks: rectangles of pixels as units of work.
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

using Block = PixelRectangle;  ///< a rectangle in its role as a unit of work

/// Side of square blocks: a multiple of `alignment` (>= 1), at most 64 or `alignment`, small enough
/// that each of `workers` gets about 32 blocks to even out their cost, where there are that many
/// pixels.
[[nodiscard]] int block_side(int width, int height, int workers, int alignment);

/// `area` in squares with corners at multiples of `side`, or at the area's edge, where they may be
/// smaller: row by row from the lower left.
[[nodiscard]] std::vector<Block> squares(const PixelRectangle& area, int side);

/// These squares in stride order: consecutive blocks lie far apart, so that a costly region is
/// shared out and what is done early covers the area evenly.
[[nodiscard]] std::vector<Block> make_blocks(const PixelRectangle& area, int side);

/// The blocks that are left to render. Of a block that is known in part, quarters are, with corners
/// at multiples of `alignment`; where it is too small for that, all of it.
/// @param known  rectangles of known pixels, which do not overlap
[[nodiscard]] std::vector<Block> blocks_left(const std::vector<Block>& blocks,
                                             const std::vector<PixelRectangle>& known,
                                             int alignment);

/// The quarters of a block, with corners at multiples of `alignment` or at its edges: at most four,
/// the block itself where it is too small.
[[nodiscard]] std::vector<Block> quarters(const Block& block, int alignment);

}  // namespace lightwalk
