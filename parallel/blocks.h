#pragma once
// Blocks: rectangles of pixels as units of work, and their distribution.
#include <atomic>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

using Block = PixelRectangle;  ///< a rectangle in its role as a unit of work

/// Side of square blocks: a multiple of `alignment` (>= 1), at most 64 or `alignment`, small enough
/// that each of `workers` gets about 32 blocks to even out their cost, where there are that many
/// pixels.
[[nodiscard]] int block_side(int width, int height, int workers, int alignment);

/// All blocks of `area`, with corners at multiples of `side` or at the area's edge, where they may
/// be smaller. In stride order: consecutive blocks lie far apart, so that a costly region is shared
/// out and what is done early covers the area evenly.
[[nodiscard]] std::vector<Block> make_blocks(const PixelRectangle& area, int side);

/// Blocks divided by whether their pixels are known already.
struct BlocksLeft {
    std::vector<Block> left;   ///< blocks to be rendered, in the original order
    std::vector<Block> known;  ///< blocks all of whose pixels are known
};

/// Divide blocks into known ones and those left to render. A block that is known in part is
/// quartered, with corners at multiples of `alignment`; where it is too small for that, it counts
/// as left.
/// @param known  rectangles of known pixels, which do not overlap
[[nodiscard]] BlocksLeft blocks_left(const std::vector<Block>& blocks,
                                     const std::vector<PixelRectangle>& known, int alignment);

/// The quarters of a block, with corners at multiples of `alignment` or at its edges: at most four,
/// the block itself where it is too small.
[[nodiscard]] std::vector<Block> quarters(const Block& block, int alignment);

/// A source of blocks, from which each worker pulls its next one (work queue).
class BlockSource {
  public:
    virtual ~BlockSource() = default;
    /// The next block, which is given out once; nothing when there are no more. May wait. Safe to
    /// call from many threads.
    [[nodiscard]] virtual std::optional<Block> next() = 0;
};

/// A list of blocks, handed out in its order to the threads of one process.
class BlockQueue final : public BlockSource {
  public:
    explicit BlockQueue(std::vector<Block> blocks) : blocks_(std::move(blocks)) {}
    [[nodiscard]] std::optional<Block> next() override {
        const std::size_t i = next_.fetch_add(1, std::memory_order_relaxed);
        return i < blocks_.size() ? std::optional(blocks_[i]) : std::nullopt;
    }

  private:
    std::vector<Block> blocks_;
    std::atomic<std::size_t> next_{0};
};

}  // namespace lightwalk
