#pragma once
// The extensions of the x86-64 instruction set that a compiler uses of its own accord.

// F(name for __builtin_cpu_supports, macro that is 1 in code that is compiled for it).
// clang-format off
#define LIGHTWALK_COMMON_FEATURES(F)                                                             \
    F("sse3", __SSE3__) F("ssse3", __SSSE3__) F("sse4.1", __SSE4_1__) F("sse4.2", __SSE4_2__)    \
    F("popcnt", __POPCNT__) F("avx", __AVX__) F("avx2", __AVX2__) F("fma", __FMA__)              \
    F("bmi", __BMI__) F("bmi2", __BMI2__) F("fma4", __FMA4__) F("xop", __XOP__)                  \
    F("avx512f", __AVX512F__) F("avx512bw", __AVX512BW__)                                        \
    F("avx512cd", __AVX512CD__) F("avx512dq", __AVX512DQ__) F("avx512vl", __AVX512VL__)          \
    F("avx512ifma", __AVX512IFMA__) F("avx512vbmi", __AVX512VBMI__)                              \
    F("avx512vbmi2", __AVX512VBMI2__) F("avx512vnni", __AVX512VNNI__)                            \
    F("avx512bitalg", __AVX512BITALG__) F("avx512vpopcntdq", __AVX512VPOPCNTDQ__)
#ifdef __clang__  // version 14 does not know the others by name
#define LIGHTWALK_PROCESSOR_FEATURES(F) LIGHTWALK_COMMON_FEATURES(F)
#else
#define LIGHTWALK_PROCESSOR_FEATURES(F) LIGHTWALK_COMMON_FEATURES(F)                             \
    F("lzcnt", __LZCNT__) F("f16c", __F16C__) F("movbe", __MOVBE__)
#endif
// clang-format on

namespace lightwalk {

/// Which of them this build needs, in that order.
extern const bool kNeededFeatures[];

}  // namespace lightwalk
