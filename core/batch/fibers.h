#pragma once
// Pieces of work that wait in the middle for others to get as far, all on the calling thread: what
// core asks of whoever runs it.
#include <cstddef>

#include "core/math/function_ref.h"

namespace lightwalk {

/// Stacks on which work runs until it is done or waits. Used by one thread at a time; what was
/// started on one goes on there.
class Fibers {
  public:
    virtual ~Fibers() = default;  ///< none may wait
    Fibers(const Fibers&) = delete;
    Fibers& operator=(const Fibers&) = delete;

    [[nodiscard]] virtual std::size_t size() const = 0;

    /// Give fiber i its stack, unless it has one. False: there is no memory for it.
    [[nodiscard]] virtual bool prepare(std::size_t i) = 0;
    /// Run `work` on fiber i, which is prepared and idle, until it is done (true) or waits (false).
    /// It has to stay alive until it is done, and may not throw. Fibers do not start others.
    virtual bool start(std::size_t i, FunctionRef<void()> work) = 0;
    /// Let fiber i, which waits, go on; as start().
    virtual bool resume(std::size_t i) = 0;
    /// To be called in the work of a fiber: return from start() or resume().
    virtual void wait() = 0;
    /// The same: whether there is room for going deeper. What one step needs after that fits into
    /// what is left.
    [[nodiscard]] virtual bool has_room() const = 0;

  protected:
    Fibers() = default;
};

}  // namespace lightwalk
