#pragma once
// Interface for running independent tasks while a scene is built: core has no threads of its own.
#include <algorithm>
#include <cstddef>

#include "core/math/function_ref.h"

namespace lightwalk {

/// Runs the independent parts of a task, possibly in parallel.
class TaskRunner {
  public:
    virtual ~TaskRunner() = default;
    /// Calls part(0) ... part(count - 1), each once, and returns when all have ended. The first
    /// exception of a part is thrown again here; parts that have not begun may be left out then.
    virtual void run(std::size_t count, FunctionRef<void(std::size_t part)> part) const = 0;
};

/// Runs the parts one after the other, in the calling thread.
class SerialTaskRunner final : public TaskRunner {
  public:
    void run(std::size_t count, FunctionRef<void(std::size_t part)> part) const override {
        for (std::size_t i = 0; i < count; ++i) part(i);
    }
};

/// Number of items in one part: enough to be worth scheduling.
inline constexpr std::size_t kGrain = 8192;

[[nodiscard]] constexpr std::size_t part_count(std::size_t things) {
    return (things + kGrain - 1) / kGrain;
}

/// Calls body(part, first, last) for ranges of at most kGrain things that make up [0, things).
template <class Body>
void for_each_part(const TaskRunner& task_runner, std::size_t things, Body&& body) {
    task_runner.run(part_count(things), [&](std::size_t part) {
        body(part, part * kGrain, std::min((part + 1) * kGrain, things));
    });
}

}  // namespace lightwalk
