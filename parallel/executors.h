#pragma once
// The executors that have a file of their own; see executor.h for how to get one.
#include <memory>

#include "parallel/executor.h"

namespace lightwalk {

[[nodiscard]] std::unique_ptr<Executor> make_thread_pool(int workers);
[[nodiscard]] std::unique_ptr<Executor> make_tbb_arena(int workers);

}  // namespace lightwalk
