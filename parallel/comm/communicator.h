#pragma once
// Communication between ranks: whole messages of bytes, in order between any two of them.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/math/function_ref.h"

namespace lightwalk {

/// One rank's end. A process by itself is a communicator of one. All calls are made by one thread,
/// but wake().
class Communicator {
  public:
    Communicator() = default;
    virtual ~Communicator() = default;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;

    [[nodiscard]] virtual int rank() const = 0;
    [[nodiscard]] virtual int size() const = 0;  ///< number of ranks, at least 1
    [[nodiscard]] virtual std::string host() const = 0;
    /// Whether all ranks are on one machine, and can map each other's memory.
    [[nodiscard]] virtual bool on_one_machine() const = 0;
    /// The lowest of the ranks on this rank's machine, which can map each other's memory.
    [[nodiscard]] virtual int first_on_machine() const = 0;

    /// Returns at once: the bytes are on their way. What one rank sends another arrives in order.
    virtual void send(int to, std::string bytes) = 0;

    struct Packet {
        int from = 0;
        std::string bytes;
    };
    /// The next message that has arrived; nothing: none has. Never waits.
    [[nodiscard]] virtual std::optional<Packet> receive() = 0;

    /// Wait until a message may have arrived, wake() was called since the last wait, or `most` has
    /// passed. Leaves the core to others meanwhile.
    virtual void wait(std::chrono::microseconds most) = 0;
    /// Ends a wait(). From any thread.
    virtual void wake() = 0;

    /// Rank 0's bytes, on every rank: all must call it, in the same order. Waits for rank 0, and
    /// calls `meanwhile` now and then while it does.
    [[nodiscard]] virtual std::string broadcast(std::string bytes,
                                                FunctionRef<void()> meanwhile) = 0;
    [[nodiscard]] std::string broadcast(std::string bytes) {
        return broadcast(std::move(bytes), [] {});
    }

    /// Waits until all that was sent has left, so that the rank may end.
    virtual void flush() = 0;

    /// End every rank, now, with this exit status.
    [[noreturn]] virtual void abort(int status) = 0;
};

/// Thrown by communicators in memory once another rank has aborted.
struct Aborted {
    int status = 0;
};

/// `ranks` communicators between threads of this process: the i-th belongs to the thread that plays
/// rank i. abort() makes every other one throw Aborted at its next call, and throws it itself.
[[nodiscard]] std::vector<std::unique_ptr<Communicator>> make_memory_communicators(int ranks);

}  // namespace lightwalk
