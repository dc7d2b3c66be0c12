#pragma once
// Scanlines of Radiance pictures, flat and run-length coded. Source: G. Ward's description of the
// RADIANCE picture format ("Real Pixels", Graphics Gems II, and the file format guide of the
// Radiance distribution).
#include <span>
#include <string>
#include <string_view>

#include "core/math/rgbe.h"

namespace lightwalk {

/// Append one scanline to `out`: new run-length form where Radiance writes it (17 to 32767 pixels),
/// else flat. The bytes equal Radiance's.
void encode_scanline(std::span<const Rgbe> pixels, std::string& out);

/// Take one scanline in any form off the front of `bytes`. Throws InputError with the problem alone
/// (no place) when the bytes end too soon, a run leaves the scanline, or a coded length differs
/// from `pixels.size()`.
void decode_scanline(std::string_view& bytes, std::span<Rgbe> pixels);

}  // namespace lightwalk
