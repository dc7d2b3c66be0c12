#pragma once
// What a page draws a picture from another place by: planar patches, each a square of pixels on one
// surface. Their bytes are described in io/net/README.md.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/view/view.h"

namespace lightwalk {

/// A square of pixels whose inverse depth is an affine function of the pixel's place, which on a
/// plane it is exactly. Depth is the component of the distance along the view's direction.
struct DepthPatch {
    std::uint16_t x = 0, y = 0;  ///< upper left pixel, y downward from the picture's top
    std::uint8_t level = 0;      ///< the side is 2^level pixels, at most kLargestPatch
    bool guessed = false;        ///< most of its pixels are filled from those around
    std::uint8_t edges = 0;      ///< sides beyond which another surface begins, see PatchEdge
    std::uint16_t value =
        0;  ///< inverse depth in the middle of the square [steps]; 0: infinitely far
    /// Change of the inverse depth to the right and downward [steps / kSlopeUnits / pixel]; 0 at
    /// level 0.
    std::int16_t slope_x = 0, slope_y = 0;
    friend bool operator==(const DepthPatch&, const DepthPatch&) = default;
};

enum PatchEdge : std::uint8_t { kLeftEdge = 1, kRightEdge = 2, kUpperEdge = 4, kLowerEdge = 8 };

inline constexpr int kHighestPatchLevel = 5, kLargestPatch = 1 << kHighestPatchLevel;  // [pixels]
inline constexpr int kSlopeUnits = 64;
inline constexpr int kDepthBand =
    2 * kLargestPatch;  ///< rows of pixels that are coded by themselves
/// Furthest that an inverse depth may be from its patch's [steps].
inline constexpr float kDepthTolerance = 4;

/// The distances of a picture of a perspective view.
struct DepthPicture {
    View view;  ///< of type v
    int width = 0, height = 0;
    std::span<const float> distance;  ///< along the pixels' rays from the eye [m], rows from the
                                      ///< top; 0: not known
    float step = 0;                   ///< unit of inverse depth [1/m]
};

/// The unit of inverse depth with which a picture that is drawn from `reach` [m] beside its eye has
/// every pixel within a quarter of one of its place [1/m].
[[nodiscard]] float depth_step(const View& view, int width, double reach);

/// Number of bands of a picture.
[[nodiscard]] inline int depth_bands(int height) {
    return (height + kDepthBand - 1) / kDepthBand;
}

/// The patches that cover a band of rows, each pixel once, in the order in which they are coded:
/// quadtrees of squares of kLargestPatch pixels row by row, the four quarters of a square row by
/// row. No patch reaches beyond the picture.
[[nodiscard]] std::vector<DepthPatch> depth_patches(const DepthPicture& picture, int band);

/// A band of the compressed part of the piece: whole bytes of one raw DEFLATE stream (RFC 1951)
/// that the bands of a picture make up together, each independent of the others. `last`: of the
/// picture. Throws std::bad_alloc where zlib finds no memory.
[[nodiscard]] std::string encode_depth_band(std::span<const DepthPatch> patches, bool last);

/// A piece of the bands of a picture.
/// @param patches  of all bands
[[nodiscard]] std::string encode_depth(float step, std::size_t patches,
                                       std::span<const std::string> bands);

}  // namespace lightwalk
