#pragma once
// Memory of long texts, in few pages.
#include <cstddef>

namespace lightwalk {

/// From this size on texts are worth pages of two megabytes [bytes].
inline constexpr std::size_t kWorthLargePages = std::size_t{4} << 20;

/// Asks for large pages under a block that malloc or new gave, before it is first touched: pages of
/// 4 kB that are touched for the first time take a good part of the time in which a long text is
/// read, on virtual machines above all. A hint: what is in the block stays, and where the system
/// has no such pages nothing happens.
void prefer_large_pages(void* block) noexcept;

}  // namespace lightwalk
