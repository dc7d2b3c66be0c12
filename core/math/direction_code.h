#pragma once
// Directions in 32 bits, as Radiance's mesh and ambient files store them.
#include <cstdint>

#include "core/math/vec3.h"

namespace lightwalk {

/// Bits 0-2: x, y, z negative. Bit 3: the first field holds |x| (else |y|). Bit 4: the second holds
/// |z| (else the larger of |x| and |y|). Bits 5-17 and 18-30: the fields, magnitudes times 11584.5;
/// the third follows from the length 1. Exact to about 0.006 degrees. The zero vector has code 0,
/// no direction has.
[[nodiscard]] std::uint32_t encode_direction(const Vec3& unit);
/// Decode a direction. Every code is legal: damaged ones give some finite vector.
[[nodiscard]] Vec3 decode_direction(std::uint32_t code);

}  // namespace lightwalk
