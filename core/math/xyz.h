#pragma once
// Between radiance in Radiance's standard primaries and photometric CIE XYZ, as XYZE pictures and
// -pXYZ have it.
#include "core/math/rgb.h"

namespace lightwalk {

/// Radiance's luminous efficacy of equal-energy white [lm/W].
inline constexpr float kEfficacy = 179;

/// Radiance [W/(m² sr)] to CIE XYZ, Y in cd/m².
/// Source: chromaticities R .640 .330, G .290 .600, B .150 .060, white 1/3 1/3 (Ward Larson and
/// Shakespeare, "Rendering with Radiance", 1998, ch. 10); the matrix follows from them.
[[nodiscard]] Rgb to_xyz(const Rgb& radiance);

/// CIE XYZ, Y in cd/m², to radiance [W/(m² sr)]: the inverse of the above matrix.
[[nodiscard]] Rgb from_xyz(const Rgb& xyz);

}  // namespace lightwalk
