#pragma once
// Pixels that nobody had time for, from those around them.
#include <cstdint>
#include <span>

#include "core/math/function_ref.h"
#include "core/math/rgb.h"

namespace lightwalk {

/// Calls part(first, last) until all rows are done; many threads may do so at once.
using ForRows = FunctionRef<void(int rows, FunctionRef<void(int first, int last)> part)>;

/// Fill the unknown pixels of a picture: means of ever larger neighbourhoods are taken until one
/// holds a known pixel, and spread back by bilinear interpolation. Smooth, and linear in the number
/// of pixels however large the gaps are. Known pixels stay as they are; a picture without any is
/// left alone.
/// @param radiance  width x height pixels, row by row
/// @param known     for each: not 0 where it is
/// Source: Gortler et al., "The Lumigraph", SIGGRAPH 1996, section 3.4 (pull-push).
void fill_gaps(int width, int height, std::span<Rgb> radiance, std::span<const std::uint8_t> known,
               ForRows by_rows);
/// By one thread.
void fill_gaps(int width, int height, std::span<Rgb> radiance, std::span<const std::uint8_t> known);

}  // namespace lightwalk
