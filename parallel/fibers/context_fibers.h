#pragma once
// Fibers of Boost.Context.
#include <cstddef>
#include <memory>

#include "core/batch/fibers.h"

namespace lightwalk {

/// Stack of each [bytes]; memory is taken page by page, as it is used. There is room for going
/// deeper while half of it is left.
inline constexpr std::size_t kFiberStackBytes = std::size_t{2} << 20;

[[nodiscard]] std::unique_ptr<Fibers> make_context_fibers(std::size_t count);

}  // namespace lightwalk
