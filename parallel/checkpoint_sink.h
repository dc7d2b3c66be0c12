#pragma once
// Storage of finished blocks for a later run (checkpoint).
#include <vector>

#include "parallel/block_renderer.h"

namespace lightwalk {

class CheckpointSink {
  public:
    virtual ~CheckpointSink() = default;
    /// Blocks of this picture that an earlier run has finished; they do not overlap.
    [[nodiscard]] virtual std::vector<BlockPixels> known() = 0;
    /// Store a finished block. Safe to call from many threads.
    virtual void keep(const BlockPixels& pixels) = 0;
};

}  // namespace lightwalk
