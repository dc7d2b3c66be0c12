#pragma once

#include <doctest/doctest.h>

namespace lightwalk::test {

#if defined(__SANITIZE_THREAD__)
inline constexpr bool kOfThreads = true;
#else
inline constexpr bool kOfThreads = false;
#endif

/// Marks a long test case that runs in one thread, as in TEST_CASE("..." * one_thread).
/// ThreadSanitizer's build leaves it out: that looks for races between threads, would take minutes,
/// and could find nothing. All other builds run it.
inline const doctest::skip one_thread(kOfThreads);

/// Marks a long test case that is about numbers, whose threads do what those of other cases of its
/// file do for a shorter time: left out there, too.
inline const doctest::skip about_numbers(kOfThreads);

}  // namespace lightwalk::test
