#pragma once
// Fibers implemented by Boost.Context.
#include <cstddef>
#include <memory>

#include "core/batch/fibers.h"

namespace lightwalk {

/// Size of a fiber's stack [bytes]; its pages are committed on first use. Recursion may go deeper
/// while half of it is left.
inline constexpr std::size_t kFiberStackBytes = std::size_t{2} << 20;

[[nodiscard]] std::unique_ptr<Fibers> make_context_fibers(std::size_t count);

}  // namespace lightwalk
