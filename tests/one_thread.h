#pragma once

#include <doctest/doctest.h>

namespace lightwalk::test {

#if defined(__SANITIZE_THREAD__)
inline constexpr bool kOfThreads = true, kSanitized = true;
#elif defined(__SANITIZE_ADDRESS__)
inline constexpr bool kOfThreads = false, kSanitized = true;
#else
inline constexpr bool kOfThreads = false, kSanitized = false;
#endif

/// Marks a long test case that runs in one thread, as in TEST_CASE("..." * one_thread).
/// ThreadSanitizer's build leaves it out: that looks for races between threads, would take minutes,
/// and could find nothing. All other builds run it.
inline const doctest::skip one_thread(kOfThreads);

/// Marks a long test case that is about numbers, and does with memory and threads what other cases
/// of its file do for a shorter time: sanitizers' builds leave it out.
inline const doctest::skip about_numbers(kSanitized);

}  // namespace lightwalk::test
