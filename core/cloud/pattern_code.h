#pragma once
// What patterns multiply a surface's colour by, in a byte.
#include <cstdint>

namespace lightwalk {

/// The code of 1: of surfaces without a pattern.
inline constexpr std::uint8_t kNoPattern = 192;

/// The brightness of a pattern's colour as a byte, in sixteenths of a power of two: within 2.2 %
/// from 1/4096 to 15; 0 for what is darker.
[[nodiscard]] std::uint8_t encode_pattern(float brightness);
[[nodiscard]] float decode_pattern(std::uint8_t code);

}  // namespace lightwalk
