#include "io/files/large_pages.h"

#include <malloc.h>
#include <sys/mman.h>

#include <cstdint>

namespace lightwalk {

void prefer_large_pages(std::string& text) noexcept {
    constexpr std::uintptr_t kPage = 4096;
    if (text.capacity() < kWorthLargePages) return;  // a short one is no block of malloc's
    char* const block = text.data();
    const std::size_t size = malloc_usable_size(block);
    // All of the mapping that malloc made for it, its own words before the block among it: a
    // mapping of two kinds cannot be moved as one.
    const auto begin = reinterpret_cast<std::uintptr_t>(block);
    const std::uintptr_t first = begin / kPage * kPage;
    const std::uintptr_t last = (begin + size + kPage - 1) / kPage * kPage;
    (void)madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);  // NOLINT
}

}  // namespace lightwalk
