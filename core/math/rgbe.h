#pragma once
// Shared-exponent pixels: three mantissas of eight bits and one exponent.
#include "core/math/rgb.h"

namespace lightwalk {

struct Rgbe {
    unsigned char r = 0, g = 0, b = 0, e = 0;
    friend bool operator==(const Rgbe&, const Rgbe&) = default;
};
/// Encode a colour. Mantissas are truncated; negative components and NaN become 0, components
/// beyond 2^127 the largest value; colours up to 1e-32 become black. Source: Ward, "Real Pixels",
/// Graphics Gems II (1991).
[[nodiscard]] Rgbe encode_rgbe(const Rgb& color);
/// Decode to the middle of the interval that the bytes represent, (m + 0.5) 2^(e - 136); 0 for e =
/// 0. Every byte pattern is legal.
[[nodiscard]] Rgb decode_rgbe(const Rgbe& pixel);

}  // namespace lightwalk
