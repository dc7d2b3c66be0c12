#pragma once
// Rectangles of pixels: the unit of work that is handed out.
#include <cstddef>
#include <vector>

namespace lightwalk {

/// Pixels x0 <= x < x1, y0 <= y < y1; x from the left, y from the bottom of the picture.
struct Block {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] int width() const { return x1 - x0; }
    [[nodiscard]] int height() const { return y1 - y0; }
    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
    friend bool operator==(const Block&, const Block&) = default;
};

/// Side of square blocks: a multiple of `alignment` (>= 1), at most 64 or `alignment`, small enough
/// that each of `workers` gets about 32 blocks to even out their cost, where there are that many
/// pixels.
[[nodiscard]] int block_side(int width, int height, int workers, int alignment);

/// All blocks of a width x height picture with corners at multiples of `side`; those at the right
/// and upper edge may be smaller. In stride order: consecutive blocks lie far apart, so that a
/// costly region is shared out and what is done early covers the picture evenly.
[[nodiscard]] std::vector<Block> make_blocks(int width, int height, int side);

}  // namespace lightwalk
