#pragma once
// The CIE 1931 standard colorimetric observer, summed over wavelengths.
#include <array>

namespace lightwalk {

/// The part of the observer's sensitivity that lies at or below a wavelength: 0 to 1 for each of X,
/// Y and Z, so that a spectrum of equal energy is (1, 1, 1). Fractions of a nanometre are cut off.
/// As in Radiance the sum includes the nanometre above, which moves colours by 1 to 4 %.
/// @param wavelength  [nm], any number
/// Source: CIE 1931 colour-matching functions, 2 degree observer, at 1 nm (CIE dataset
/// 10.25039/CIE.DS.xvudnb9b).
[[nodiscard]] std::array<double, 3> observer_below(double wavelength);

}  // namespace lightwalk
