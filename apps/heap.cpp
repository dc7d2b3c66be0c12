#include "apps/heap.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace lightwalk {
namespace {

constexpr std::size_t kHeap = std::size_t{32} << 20;       ///< reserved, not used [bytes]
constexpr std::size_t kOwnMapping = std::size_t{4} << 20;  ///< from this size given back at once
constexpr std::size_t kLargePage = std::size_t{2} << 20;

}  // namespace

void prepare_heap() {
    if (mallopt(M_TOP_PAD, static_cast<int>(kHeap)) == 0) return;
    mallopt(M_MMAP_THRESHOLD, static_cast<int>(kOwnMapping));
    // More than what is left of the heap, so that it grows; a compiler may leave out what is
    // unused.
    const auto before = reinterpret_cast<std::uintptr_t>(sbrk(0));
    void* volatile block = std::malloc(std::size_t{1} << 20);
    std::free(block);
    const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
    const std::uintptr_t start = (before + kLargePage - 1) / kLargePage * kLargePage;
    if (end > start)  // it is this allocator that grew it
        (void)madvise(reinterpret_cast<void*>(start), end - start, MADV_HUGEPAGE);
}

}  // namespace lightwalk
