#pragma once
// Decodes pictures of spectra, for patterns that look up their values.
#include <string>
#include <string_view>

#include "core/model/resources.h"

namespace lightwalk {

/// Decode a picture of FORMAT Radiance_spectra (any orientation; flat or run-length coded) to a
/// table whose shorter side has length 1, as decode_picture does. NCOMP is the number of bands, the
/// first and the last number of WAVELENGTH_SPLITS their outer edges [nm]. Throws InputError "name:
/// ..." for other formats and damaged files, and allocates no more than the size of the file
/// justifies. Source: Radiance's notes on hyperspectral rendering.
[[nodiscard]] SpectralPicture decode_spectral_picture(std::string_view bytes,
                                                      const std::string& name);

}  // namespace lightwalk
