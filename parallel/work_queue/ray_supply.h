#pragma once
// A stream of rays as a supply of chunks.
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "parallel/work_queue/outbox.h"

namespace lightwalk {

/// Chunks of rays in their order, and their answers in the same order. The program is asked for
/// every chunk, so that never more than a window of them are on their way (backpressure): neither
/// input nor output is ever held as a whole.
class RaySupply {
  public:
    /// @param window  chunks whose answers the program has not got, at most; at least 1
    explicit RaySupply(std::uint32_t window) : window_(window) {}

    /// Asks the program for the first chunks.
    void begin(Outbox& out) { out.program.emplace_back(ChunksWanted{window_, good_size()}); }
    void add(RayChunk chunk) { chunks_.push_back(std::move(chunk)); }
    [[nodiscard]] std::optional<RayChunk> next();
    void note(const FinishedWork& finished);
    /// Answers go to the program once all before them have.
    void gather(RayAnswer answer, Outbox& out);

    /// Rays that a chunk should have: few until it is known what they take, then as many as keep a
    /// thread busy for about a fiftieth of a second.
    [[nodiscard]] std::uint32_t good_size() const;

  private:
    std::uint32_t window_;
    std::deque<RayChunk> chunks_;  ///< to be handed out
    std::map<std::uint64_t, RayAnswer> early_;
    std::uint64_t next_ = 0;         ///< chunk whose answer the program gets next
    double rays_ = 0, seconds_ = 0;  ///< of late
};

}  // namespace lightwalk
