#pragma once
// Shared-exponent pixels: three mantissas of eight bits and one exponent.
#include "core/math/rgb.h"

namespace lightwalk {

struct Rgbe {
    unsigned char r = 0, g = 0, b = 0, e = 0;
    friend bool operator==(const Rgbe&, const Rgbe&) = default;
};
/// The colour's four bytes: mantissas cut off, what is negative or no number is 0, what is beyond
/// 2^127 is the largest; all zero for colours up to 1e-32. Source: Ward, "Real Pixels", Graphics
/// Gems II (1991).
[[nodiscard]] Rgbe encode_rgbe(const Rgb& color);
/// The middle of what the bytes can stand for, (m + 0.5) 2^(e - 136); every pattern is legal, 0 for
/// e = 0.
[[nodiscard]] Rgb decode_rgbe(const Rgbe& pixel);

}  // namespace lightwalk
