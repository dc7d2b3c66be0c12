#pragma once
// The executor of a file of its own, which alone includes TBB; use make_executor of executor.h.
#include <memory>

#include "parallel/executor.h"

namespace lightwalk {

[[nodiscard]] std::unique_ptr<Executor> make_tbb_arena(int workers);

}  // namespace lightwalk
