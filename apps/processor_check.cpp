// Ends the program in a sentence where it would die of an illegal instruction. This file alone is
// compiled for every x86-64 processor, never optimised together with others, and calls nothing of
// ours, not even an inline function: the linker might take another file's copy of that.
#include <unistd.h>

#include <cstdio>

#include "apps/processor_features.h"

namespace lightwalk {
namespace {

void require(const char* feature, bool needed, bool present) {
    if (!needed || present) return;
    dprintf(STDERR_FILENO,
            "lightwalk: this processor lacks %s, which the program was built to use "
            "(LIGHTWALK_ISA=%s; the lowest level that it can be built for is x86-64-v2)\n",
            feature, LIGHTWALK_ISA);
    _exit(1);
}

/// Before all other constructors of the program: those are compiled for what this one looks for.
[[gnu::constructor(101)]] void check_processor() {
    __builtin_cpu_init();
    const bool* needed = kNeededFeatures;
#define LIGHTWALK_REQUIRE(name, macro) require(name, *needed++, __builtin_cpu_supports(name) != 0);
    LIGHTWALK_PROCESSOR_FEATURES(LIGHTWALK_REQUIRE)
}

}  // namespace
}  // namespace lightwalk
