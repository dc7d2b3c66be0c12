#pragma once
// Fewer rays than pixels: trace the corners of squares, then interpolate or subdivide.
#include <span>

#include "core/math/function_ref.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Traces pixels: values[i] is set for places[i].
using TracePixels =
    FunctionRef<void(std::span<const PixelPlace> places, std::span<PixelValue> values)>;
/// Takes the final value of one pixel.
using StorePixel = FunctionRef<void(const PixelPlace& place, const PixelValue& value)>;

struct RefineOptions {
    int spacing = 4;  ///< side of the squares [pixels], >= 1
    double threshold =
        0.05;  ///< corners that differ by more than this share of the smaller one are subdivided
    bool by_distance = false;  ///< distances count, too
};

/// Tiles are refined independently of each other: their side is a function of the spacing alone.
[[nodiscard]] int refine_tile_side(int spacing);

/// Whether two to four values call for subdivision: in any channel max - min > threshold * min, or
/// (by distance) 2 (max - min) > threshold * (max + min). Source: Radiance manual page rpict(1),
/// -pt.
[[nodiscard]] bool differ(std::span<const PixelValue> values, const RefineOptions& options);

/// Set every pixel of `tile` (corners at multiples of refine_tile_side, or at the picture's edge),
/// of a width x height picture. Squares of `spacing` pixels, aligned with the picture's lower left
/// corner, are traced at their corners; where those differ the square is quartered and the new
/// corners are traced, else the pixels between are interpolated linearly. A pixel belongs to the
/// square whose lower left corner it is at or beyond, so the result is a pure function of the
/// traced values: tiles, blocks and threads do not show.
void refine_tile(const PixelRectangle& tile, int width, int height, const RefineOptions& options,
                 TracePixels trace, StorePixel store);

}  // namespace lightwalk
