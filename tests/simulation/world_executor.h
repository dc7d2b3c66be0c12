#pragma once
// Two threads of a simulated rank.
#include <cstddef>
#include <exception>

#include "parallel/executor.h"
#include "tests/simulation/world.h"

namespace lightwalk::simulation {

class WorldExecutor final : public Executor {
  public:
    explicit WorldExecutor(World& world) : world_(world) {}
    using Executor::for_each;
    void for_each(std::size_t count, Task task, const StopFlag& stop) override {
        std::size_t next = 0;
        std::exception_ptr problem;
        const auto work = [&](int worker) {
            while (next < count && !problem && !stop.requested()) {
                try {
                    task(next++, worker);
                } catch (const Killed&) {
                    throw;
                } catch (...) {
                    problem = std::current_exception();
                }
            }
        };
        if (count > 1)
            world_.side_by_side([&] { work(1); }, [&] { work(0); });
        else
            work(0);
        if (problem) std::rethrow_exception(problem);
    }
    [[nodiscard]] int concurrency() const override { return 2; }

  private:
    World& world_;
};

}  // namespace lightwalk::simulation
