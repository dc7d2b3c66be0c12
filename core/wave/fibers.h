#pragma once
// Pieces of work that wait in the middle for others to get as far, all on the calling thread.
#include <cstddef>
#include <memory>
#include <vector>

#include "core/math/function_ref.h"

namespace lightwalk {

/// Stacks on which work runs until it is done or waits. Not shared between threads: what was
/// started on one goes on there.
class Fibers {
  public:
    /// Stack of each [bytes]; memory is taken page by page, as it is used. Work asks has_room()
    /// before it goes deeper: what one step needs after that fits into half of it.
    static constexpr std::size_t kStackBytes = std::size_t{2} << 20;

    explicit Fibers(std::size_t count);
    ~Fibers();  ///< none may wait
    Fibers(const Fibers&) = delete;
    Fibers& operator=(const Fibers&) = delete;

    [[nodiscard]] std::size_t size() const { return all_.size(); }

    /// Give fiber i its stack, unless it has one. False: there is no memory for it.
    [[nodiscard]] bool prepare(std::size_t i);
    /// Run `work` on fiber i, which is prepared and idle, until it is done (true) or waits (false).
    /// It has to stay alive until it is done, and may not throw. Fibers do not start others.
    bool start(std::size_t i, FunctionRef<void()> work);
    /// Let fiber i, which waits, go on; as start().
    bool resume(std::size_t i);
    /// To be called in the work of a fiber: return from start() or resume().
    void wait();
    /// The same: whether half of the stack is left.
    [[nodiscard]] bool has_room() const;

  private:
    class Fiber;
    bool enter(std::size_t i);

    std::vector<std::unique_ptr<Fiber>> all_;
    Fiber* running_ = nullptr;
};

}  // namespace lightwalk
