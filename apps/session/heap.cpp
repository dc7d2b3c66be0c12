#include "apps/session/heap.h"

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
constexpr int kSmallPad = 128 << 10;                       ///< free and kept, where memory counts
constexpr std::size_t kLargePage = std::size_t{2} << 20;

}  // namespace

void prepare_heap() {
    // NOLINTBEGIN(concurrency-mt-unsafe): there is one thread
    if (mallopt(M_TOP_PAD, static_cast<int>(kHeap)) == 0) return;
    mallopt(M_MMAP_THRESHOLD, static_cast<int>(kOwnMapping));
    // NOLINTEND(concurrency-mt-unsafe)
    // More than what is left of the heap, so that it grows; a compiler may leave out what is
    // unused.
    char* const before = static_cast<char*>(sbrk(0));
    void* volatile block = std::malloc(std::size_t{1} << 20);
    std::free(block);
    char* const end = static_cast<char*>(sbrk(0));
    const std::size_t beyond = reinterpret_cast<std::uintptr_t>(before) % kLargePage;
    char* const start = before + (kLargePage - beyond) % kLargePage;
    if (end > start)  // it is this allocator that grew it
        (void)madvise(start, static_cast<std::size_t>(end - start), MADV_HUGEPAGE);
}

void give_back_heap() {
    (void)mallopt(M_TOP_PAD, kSmallPad);  // NOLINT(concurrency-mt-unsafe): takes the heap's lock
    (void)malloc_trim(0);
}

}  // namespace lightwalk
