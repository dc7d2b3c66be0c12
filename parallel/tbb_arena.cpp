#include "parallel/tbb_arena.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

namespace lightwalk {
namespace {

/// Nested rays (Tracer::kMaxDepth) need more stack than TBB gives its threads.
constexpr std::size_t kStackBytes = std::size_t{32} << 20;

/// Executor implemented by a oneTBB arena.
class TbbArena final : public Executor {
  public:
    using Executor::for_each;

    explicit TbbArena(int workers)
        : stack_(tbb::global_control::thread_stack_size, kStackBytes),
          threads_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(workers)),
          arena_(workers) {}

    /// Ranges are split down to single calls, but each call takes the next number from a counter:
    /// TBB balances the load, and the tasks still begin in their order.
    void for_each(std::size_t count, Task task, const StopFlag& stop) override {
        std::atomic<std::size_t> next{0};
        arena_.execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, count),
                [&](const tbb::blocked_range<std::size_t>& range) {
                    for (std::size_t i = range.begin(); i != range.end() && !stop.requested();
                         ++i) {
                        task(next.fetch_add(1, std::memory_order_relaxed),
                             tbb::this_task_arena::current_thread_index());
                    }
                },
                tbb::simple_partitioner());
        });
    }
    [[nodiscard]] int concurrency() const override { return arena_.max_concurrency(); }

  private:
    tbb::global_control stack_;
    tbb::global_control threads_;
    tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<Executor> make_tbb_arena(int workers) {
    return std::make_unique<TbbArena>(workers);
}

}  // namespace lightwalk
