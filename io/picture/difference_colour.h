#pragma once
// The relative difference of two luminances as a colour, with its sign.
#include <array>
#include <cstdint>

namespace lightwalk {

/// Where a difference lies on its scale, which is even about none, and logarithmic far from it:
/// with r = log2(now / before), in octaves, sign(r) log(1 + |r| / r0) / log(1 + 4 / r0), r0 = 0.1.
/// @return  -1 (a sixteenth, or less) ... 0 (the same) ... 1 (16 times as much, or more); 0 where
///          both are 0, or one is no number
[[nodiscard]] double difference_place(float before, float now);

/// The colour of a difference: sRGB bytes, blue where there is less, grey where there is the same,
/// orange where there is more. The page has the same scale (apps/viewer/difference.js).
[[nodiscard]] std::array<std::uint8_t, 3> difference_colour(float before, float now);

/// The same for a place on the scale, -1 ... 1.
[[nodiscard]] std::array<std::uint8_t, 3> difference_colour_at(double place);

}  // namespace lightwalk
