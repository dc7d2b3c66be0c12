#pragma once

#include <doctest/doctest.h>

namespace lightwalk::test {

/// Marks a long test case that runs in one thread, as in TEST_CASE("..." * one_thread).
/// ThreadSanitizer's build leaves it out: that looks for races between threads, would take minutes,
/// and could find nothing. All other builds run it.
#if defined(__SANITIZE_THREAD__)
inline const doctest::skip one_thread(true);
#else
inline const doctest::skip one_thread(false);
#endif

}  // namespace lightwalk::test
