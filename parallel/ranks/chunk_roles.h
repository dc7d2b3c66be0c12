#pragma once
// What ranks do that trace rays from a stream: the steps of who deals them out and of who takes
// them (see roles.h).
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>

#include "parallel/ranks/message.h"
#include "parallel/ranks/roles.h"

namespace lightwalk {

/// Deals out chunks of rays in their order and passes on their answers in the same order. It asks
/// the program for every chunk, so that never more than a window of them are between the two:
/// neither input nor output is ever held as a whole.
class ChunkMasterRole {
  public:
    /// @param self    its own address
    /// @param window  chunks whose answers the program has not got, at most; at least 1
    ChunkMasterRole(Address self, std::uint32_t window) : self_(self), window_(window) {}

    /// Asks the program for the first chunks.
    void begin(Outbox& out);
    /// From workers: AskChunks, ChunkAnswer. From the program: RayChunk. To the program: AskChunks,
    /// ChunkAnswer.
    void handle(Envelope envelope, Outbox& out);

    /// Rays that a chunk should have: few until it is known what they take, then as many as keep a
    /// thread busy for about a fiftieth of a second.
    [[nodiscard]] std::uint32_t good_size() const;

  private:
    void settle(ChunkAnswer answer, Outbox& out);
    void serve(Outbox& out);

    Address self_;
    std::uint32_t window_;
    std::deque<RayChunk> chunks_;  ///< to be handed out
    std::deque<Address> wishes_;   ///< one for each chunk that is wanted
    std::map<std::uint64_t, ChunkAnswer> early_;
    std::uint64_t next_ = 0;         ///< chunk whose answer the program gets next
    double rays_ = 0, seconds_ = 0;  ///< of late
};

/// Asks for chunks in the name of the rank's threads.
class ChunkWorkerRole {
  public:
    /// @param slots  threads that trace here
    /// @param ahead  chunks that wait here so that no thread does
    ChunkWorkerRole(Address self, Address master, int slots, int ahead)
        : self_(self), master_(master), wanted_(static_cast<std::uint32_t>(slots + ahead)) {}

    void begin(Outbox& out);
    /// From the master: RayChunk, handed to the tracer. From the tracer: ChunkAnswer.
    void handle(Envelope envelope, Outbox& out);

  private:
    Address self_, master_;
    std::uint32_t wanted_;
};

}  // namespace lightwalk
