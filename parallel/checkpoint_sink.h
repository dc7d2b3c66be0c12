#pragma once
// Blocks that outlive the run that rendered them.
#include <vector>

#include "parallel/block_renderer.h"

namespace lightwalk {

class CheckpointSink {
  public:
    virtual ~CheckpointSink() = default;
    /// Blocks of this picture that are known already; they do not overlap.
    [[nodiscard]] virtual std::vector<BlockPixels> known() = 0;
    /// A finished block; called by many threads at once.
    virtual void keep(const BlockPixels& pixels) = 0;
};

}  // namespace lightwalk
