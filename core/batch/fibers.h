#pragma once
// Coroutines with stacks of their own (fibers), run by the calling thread. Core uses this interface
// to let the shading of many rays meet at a barrier.
#include <cstddef>

#include "core/math/function_ref.h"

namespace lightwalk {

/// A fixed number of fibers. Each runs a function until it returns or waits, and goes on from there
/// when it is resumed. One thread at a time may use the object.
class Fibers {
  public:
    virtual ~Fibers() = default;  ///< no fiber may be waiting
    Fibers(const Fibers&) = delete;
    Fibers& operator=(const Fibers&) = delete;

    [[nodiscard]] virtual std::size_t size() const = 0;

    /// Allocate the stack of fiber i, unless it has one. False: there is no memory for it.
    [[nodiscard]] virtual bool prepare(std::size_t i) = 0;
    /// Run `work` on fiber i, which must be prepared and idle, until it returns (result: true) or
    /// waits (false). `work` must stay alive until it has returned, must not throw and must not
    /// start other fibers.
    virtual bool start(std::size_t i, FunctionRef<void()> work) = 0;
    /// Resume fiber i, which is waiting, until its work returns (true) or waits again (false).
    virtual bool resume(std::size_t i) = 0;
    /// Called by the work of a fiber: suspend it, and return false from start() or resume().
    virtual void wait() = 0;
    /// Called by the work of a fiber: whether its stack has room for one more level of recursion.
    [[nodiscard]] virtual bool has_room() const = 0;

  protected:
    Fibers() = default;
};

}  // namespace lightwalk
