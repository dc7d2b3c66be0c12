#pragma once
// Adaptive sampling with fewer rays than pixels: a grid of pixels is traced; of the pixels in
// between it is decided, level by level, which are traced and which are interpolated.
//
// The picture is divided into independent tiles. A tile begins with a grid of
// traced pixels, its border lines among them, and halves the distances between the lines until each
// line of pixels has its turn: first the pixels between four corners, then those on the sides,
// which have a neighbour on either side along their line and across it. Such a pixel
//  - is interpolated from all its neighbours where these differ by no more than the threshold;
//  - is interpolated from the opposite pair that is most alike, as along an edge, if that is alike
//    enough: the more the others differ, the more light is at stake, and the closer it must be;
//  - is traced otherwise.
// What lies between samples is lost to any such rule, and light is lost more often than shadow
// where sparkles (sun through leaves, on metal) are small and bright. Two rules bring it back. A
// traced pixel that stands out among the eight around it shows that there is more of its kind: the
// cells around it are traced at the next level without asking. And when all pixels are decided,
// those around a traced pixel of that kind are traced as well, and so on along thin lines and
// through clusters (adaptive cluster sampling: Thompson, "Adaptive Cluster Sampling", J. Am. Stat.
// Assoc. 85 (1990), pp. 1050-1059). Where a tile glitters all over, a fixed pattern of pixels takes
// the mean of its neighbours whatever these are, which favours neither light nor dark and saves
// rays. The grid has about as many pixels as rpict's at the same -ps.
#include <span>

#include "core/math/function_ref.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Traces pixels: values[i] is set for places[i].
using TracePixels =
    FunctionRef<void(std::span<const PixelPlace> places, std::span<PixelValue> values)>;
/// Receives the final value of one pixel.
using StorePixel = FunctionRef<void(const PixelPlace& place, const PixelValue& value)>;

struct RefineOptions {
    int spacing = 4;          ///< approximate distance of the pixels that are traced first, >= 1
    double threshold = 0.05;  ///< neighbours that differ by more than this share of the smaller one
                              ///< are not interpolated
    bool by_distance = false;  ///< compare distances, too
};

/// Side of the tiles that are refined independently of each other: a function of the spacing only.
[[nodiscard]] int refine_tile_side(int spacing);

/// Whether two or more values differ too much for interpolation: in any channel
/// max - min > threshold * min, or (by distance) 2 (max - min) > threshold * (max + min).
/// Source: Radiance manual page rpict(1), -pt.
[[nodiscard]] bool differ(std::span<const PixelValue> values, const RefineOptions& options);

/// Set every pixel of `tile` (corners at multiples of refine_tile_side, or at the picture's edge),
/// each traced at most once, none outside. The result is a pure function of the tile, the options
/// and the traced values, independent of blocks, threads and windows. At a spacing of 1 every pixel
/// is traced.
void refine_tile(const PixelRectangle& tile, const RefineOptions& options, TracePixels trace,
                 StorePixel store);

}  // namespace lightwalk
