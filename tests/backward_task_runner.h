#pragma once
// A task runner for tests of what must not depend on who does what first.
#include "core/math/task_runner.h"

namespace lightwalk::test {

/// Runs the parts from the last to the first.
class BackwardTaskRunner final : public TaskRunner {
  public:
    void run(std::size_t count, FunctionRef<void(std::size_t part)> part) const override {
        while (count-- > 0) part(count);
    }
};

}  // namespace lightwalk::test
