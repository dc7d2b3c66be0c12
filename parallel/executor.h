#pragma once
// Executors run independent tasks: in one thread, a pool of std::threads, or a TBB arena.
#include <cstddef>
#include <memory>

#include "core/math/function_ref.h"
#include "parallel/stop_flag.h"

namespace lightwalk {

/// A task, called with its number and the index of its worker. No two tasks run with the same
/// worker index at the same time, so that it can index scratch memory.
using Task = FunctionRef<void(std::size_t task, int worker)>;

class Executor {
  public:
    virtual ~Executor() = default;

    /// Run tasks 0 ... count-1, each once, handed out in about this order; return when all are
    /// done. No new task starts once `stop` is requested. The first exception of a task ends the
    /// others the same way and is thrown again here. Not to be called from within a task, nor from
    /// two threads at once.
    virtual void for_each(std::size_t count, Task task, const StopFlag& stop) = 0;
    void for_each(std::size_t count, Task task) { for_each(count, task, never_); }

    /// Number of workers; worker indices are below it.
    [[nodiscard]] virtual int concurrency() const = 0;

  private:
    StopFlag never_;
};

enum class ExecutorKind {
    serial,   ///< the calling thread only
    threads,  ///< std::thread, which ThreadSanitizer understands
    tbb,      ///< a TBB arena
};

/// The default: TBB, or std::thread under ThreadSanitizer, which reports false races in the
/// packaged libtbb.
#if defined(__SANITIZE_THREAD__)
inline constexpr ExecutorKind kDefaultExecutor = ExecutorKind::threads;
#else
inline constexpr ExecutorKind kDefaultExecutor = ExecutorKind::tbb;
#endif

/// Make an executor of `workers` >= 1 threads, including the calling one; `serial` always has one.
[[nodiscard]] std::unique_ptr<Executor> make_executor(ExecutorKind kind, int workers);

/// Number of hardware threads this process may use, at least 1.
[[nodiscard]] int hardware_threads();

}  // namespace lightwalk
