#pragma once
// Makers of the executors of separate files; use make_executor of executor.h.
#include <memory>

#include "parallel/executor.h"

namespace lightwalk {

[[nodiscard]] std::unique_ptr<Executor> make_thread_pool(int workers);
[[nodiscard]] std::unique_ptr<Executor> make_tbb_arena(int workers);

}  // namespace lightwalk
