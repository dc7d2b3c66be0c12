#pragma once
// Memory of long arrays, in few pages.
#include <cstddef>

namespace lightwalk {

/// From this size on arrays are worth pages of two megabytes [bytes].
inline constexpr std::size_t kWorthLargePages = std::size_t{4} << 20;

/// Asks for large pages under an array that malloc or new gave, before it is first touched or
/// after it was moved: pages of 4 kB that are touched for the first time take up to half of the
/// time in which a large scene is read, on virtual machines above all. A hint: what is in the array
/// stays, and where the system has no such pages nothing happens.
void prefer_large_pages(void* block) noexcept;

}  // namespace lightwalk
