#pragma once
// Adapts an executor to the TaskRunner interface of core.
#include "core/math/task_runner.h"
#include "parallel/executor.h"

namespace lightwalk {

/// The executor must outlive the task runner, and do nothing else while it runs.
class ExecutorTaskRunner final : public TaskRunner {
  public:
    explicit ExecutorTaskRunner(Executor& executor) : executor_(executor) {}
    void run(std::size_t count, FunctionRef<void(std::size_t part)> part) const override {
        executor_.for_each(count, [&](std::size_t task, int) { part(task); });
    }

  private:
    Executor& executor_;
};

}  // namespace lightwalk
