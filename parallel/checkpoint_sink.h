#pragma once
// Storage of finished blocks, and of rounds of ambient values, for a later run (checkpoint).
#include <string>
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
    /// What an earlier run has kept of the steps of this picture's rounds (see AmbientRounds), in
    /// their order. Where those did not begin as `beginning` says: nothing, and what is kept from
    /// now on takes its place.
    [[nodiscard]] virtual std::vector<std::string> known_steps(const std::string& beginning) = 0;
    /// Store what came of the next step.
    virtual void keep_step(std::string step) = 0;
};

}  // namespace lightwalk
