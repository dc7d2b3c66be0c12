#pragma once
// Encodes and decodes scanlines of Radiance pictures, flat or run-length coded. Source: G. Ward's
// description of the RADIANCE picture format ("Real Pixels", Graphics Gems II, and the file format
// guide of the Radiance distribution).
#include <span>
#include <string>
#include <string_view>

#include "core/math/rgbe.h"

namespace lightwalk {

/// Append a scanline to `out`, in the new run-length form where Radiance uses it (17 to 32767
/// pixels), else flat. The bytes equal Radiance's.
void encode_scanline(std::span<const Rgbe> pixels, std::string& out);

/// Remove a scanline of any form from the front of `bytes` and decode it. Throws InputError,
/// without a place, when the bytes end too soon, a run is longer than the rest of the scanline, or
/// a coded length differs from `pixels.size()`.
void decode_scanline(std::string_view& bytes, std::span<Rgbe> pixels);

}  // namespace lightwalk
