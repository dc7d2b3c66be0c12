#include "parallel/executor.h"

#include <algorithm>
#include <thread>

#include "parallel/executors.h"

namespace lightwalk {
namespace {

class SerialExecutor final : public Executor {
  public:
    using Executor::for_each;
    void for_each(std::size_t count, Task task, const StopFlag& stop) override {
        for (std::size_t i = 0; i < count && !stop.requested(); ++i) task(i, 0);
    }
    [[nodiscard]] int concurrency() const override { return 1; }
};

}  // namespace

std::unique_ptr<Executor> make_executor(ExecutorKind kind, int workers) {
    workers = std::max(workers, 1);
    switch (kind) {
        case ExecutorKind::serial:
            break;
        case ExecutorKind::threads:
            return make_thread_pool(workers);
        case ExecutorKind::tbb:
            return make_tbb_arena(workers);
    }
    return std::make_unique<SerialExecutor>();
}

int hardware_threads() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace lightwalk
