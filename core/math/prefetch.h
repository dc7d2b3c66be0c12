#pragma once
// Prefetching of memory that will be needed soon.

namespace lightwalk {

/// Fetch the cache line at an address while something else is computed. Functions that do nothing
/// but call this have to be inlined by force: GCC takes them for functions without effect, and
/// drops their calls.
[[gnu::always_inline]] inline void prefetch(const void* address) {
    __builtin_prefetch(address);
}

}  // namespace lightwalk
