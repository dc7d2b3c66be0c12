#include "io/files/forget_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace lightwalk {

void forget_pages(std::span<char> bytes) noexcept {
    const long page_size = sysconf(_SC_PAGESIZE);
    if (page_size <= 0) return;
    const auto page = static_cast<std::uintptr_t>(page_size);
    const auto begin = reinterpret_cast<std::uintptr_t>(bytes.data());
    const std::uintptr_t first = (begin + page - 1) / page * page;
    const std::uintptr_t last = (begin + bytes.size()) / page * page;
    if (first >= last) return;
    // The pages are the heap's own: they are zero when they are looked at next.
    (void)madvise(bytes.data() + (first - begin), last - first, MADV_DONTNEED);
}

void FadingText::forget_to(std::size_t offset) {
    offset = std::min(offset, text_.size());
    // A page that two stretches share stays: one of two thousand.
    forget_pages(std::span(text_.data() + forgotten_, offset - forgotten_));
    forgotten_ = offset;
}

}  // namespace lightwalk
