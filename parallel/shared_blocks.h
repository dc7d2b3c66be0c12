#pragma once
// Blocks whose pixels workers share where there are few blocks, each of which takes long.
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "core/view/pixels.h"
#include "parallel/blocks.h"

namespace lightwalk {

/// Hands out the pixels of blocks, one by one. A worker begins the next block and goes through it
/// in the order of BlockRenderer, whose packets are `side` pixels wide and high. Once every block
/// has begun, a worker that has none left helps with the one that has most left, from its end: the
/// values that an ambient cache gets come in nearly the order of whole blocks, and two workers are
/// seldom at places so close that they compute the same value.
/// Workers may call at the same time.
class SharedBlocks {
  public:
    /// @param workers  at least 1; theirs are the numbers below it
    SharedBlocks(std::span<const Block> blocks, int side, int workers);

    /// Of all blocks together.
    [[nodiscard]] std::size_t pixels() const { return places_.size(); }
    /// The worker's next pixel. To be called pixels() times in all.
    [[nodiscard]] PixelPlace next(int worker);

  private:
    /// Of places_, what is left of a block.
    struct Part {
        std::size_t first = 0, last = 0;
        [[nodiscard]] std::size_t left() const { return last - first; }
    };
    void add(const Block& block, int side);

    std::vector<PixelPlace> places_;  ///< by block, in the order of the renderer
    std::mutex mutex_;                // guards what follows
    std::vector<Part> parts_;         ///< by block
    std::size_t begun_ = 0;           ///< blocks
    std::vector<Part*> own_;          ///< by worker: the block that it began; null: none yet
};

}  // namespace lightwalk
