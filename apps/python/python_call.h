#pragma once
// Work that a call from Python waits for.
#include <pybind11/pybind11.h>

#include <mutex>
#include <optional>
#include <string>

#include "apps/python/bindings.h"
#include "core/math/function_ref.h"

namespace lightwalk {

/// Does `work` on a thread of its own, without the interpreter's lock: other threads of Python go
/// on. The calling thread, which holds the lock, looks every 50 ms for signals (Ctrl-C) and calls
/// `tick`. Where either raises, `cancel` is called, and what was raised is thrown once the work has
/// ended. Throws what `work` throws.
void wait_for(FunctionRef<void()> work, FunctionRef<void()> cancel, FunctionRef<void()> tick);

/// Tells a Python function how far a renderer is.
class ProgressTeller {
  public:
    /// @param listener  called with (share, rays, seconds, seconds_left or None); None: nobody is
    ///                  told
    explicit ProgressTeller(pybind11::object listener) : listener_(std::move(listener)) {}

    /// For RendererOptions::progress, which may outlive nothing but this.
    [[nodiscard]] TakeProgressReport taker();
    /// With the interpreter's lock.
    void tell();

  private:
    pybind11::object listener_;
    std::mutex mutex_;
    std::optional<RenderProgress> newest_;
};

/// What a renderer makes of a ticket; throws KeyboardInterrupt and the like where it was cancelled.
template <class Result>
Result wait_for_task(Renderer& renderer, Ticket<Result> ticket, ProgressTeller& teller) {
    std::optional<Result> result;
    wait_for([&] { result = renderer.finish(ticket); }, [&] { renderer.cancel(); },
             [&] { teller.tell(); });
    if (!result) throw InputError("the work was cancelled");
    teller.tell();
    return std::move(*result);
}

}  // namespace lightwalk
