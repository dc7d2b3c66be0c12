#pragma once
// An executor as the team that core builds scenes with.
#include "core/math/team.h"
#include "parallel/executor.h"

namespace lightwalk {

/// The executor must outlive the team, and do nothing else while it runs.
class ExecutorTeam final : public Team {
  public:
    explicit ExecutorTeam(Executor& executor) : executor_(executor) {}
    void run(std::size_t count, FunctionRef<void(std::size_t part)> part) const override {
        executor_.for_each(count, [&](std::size_t task, int) { part(task); });
    }

  private:
    Executor& executor_;
};

}  // namespace lightwalk
