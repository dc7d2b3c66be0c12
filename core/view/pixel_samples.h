#pragma once
// Where the samples of a pixel lie, and how much they count: the pixel's filter.
#include <cstdint>

#include "core/math/sequence_2d.h"
#include "core/view/pixel_options.h"

namespace lightwalk {

/// Offset from a pixel's centre [pixels], x to the right, y up.
struct PixelOffset {
    double x = 0, y = 0;
};

/// Radius of the pixel filter [pixels]: its weight at distance r is exp(-(r / 0.6)²) / (0.36 π). It
/// is the Gaussian that Radiance's `pfilt -r .6` filters with (the shape is that of its output for
/// a straight edge), so no second program is needed to average an oversized picture.
inline constexpr double kPixelFilterRadius = 0.6;

/// How far along either axis from a pixel's centre a sample counts where pixels share samples
/// [pixels]. pfilt -r .6 ends its Gaussian at 1.3: what lies beyond is .4 % of the weight.
[[nodiscard]] constexpr double pixel_filter_reach(PixelFilter filter) {
    return filter == PixelFilter::mitchell ? 2 : 1.3;
}
/// How many pixels away along either axis those are, at most, that a pixel's samples count for.
[[nodiscard]] constexpr int reached_pixels(PixelFilter filter) {
    return filter == PixelFilter::mitchell ? 2 : 1;
}

/// Whether a place may count less than nothing for a pixel.
[[nodiscard]] constexpr bool has_negative_weights(PixelFilter filter) {
    return filter == PixelFilter::mitchell;
}

/// The filter's weight along one axis, at distance `d` from the pixel's centre [pixels]; 0 beyond
/// its reach. That of a place is the product of both axes'. The Gaussian's is exp(-(d / 0.6)²).
/// Mitchell's is the cubic of B = C = 1/3, of integral 1: it keeps edges sharper, and is negative
/// from 8/7 on, by .036 at most, so that what is next to a bright edge is a little too dark and a
/// small bright thing has a dark ring. Source: Mitchell & Netravali, "Reconstruction filters in
/// computer graphics", Computer Graphics 22(4) (SIGGRAPH 1988), equation 8.
[[nodiscard]] double pixel_filter(PixelFilter filter, double d);

/// Where in its pixel a sample lies that neighbouring pixels share: samples are uniform over the
/// picture, each pixel has `count`, from -0.5 to 0.5 along either axis. `at` of all samples being a
/// (0,2)-sequence's, a power of two of them lie one in each box already. Other numbers have a grid
/// with a sample in each cell where they are the product of two like ones: nine have a tenth less
/// error.
/// @param at  uniform in the unit square
[[nodiscard]] PixelOffset shared_sample(int sample, int count, const SequencePoint& at);

/// The samples of pixel (x, y), distributed as its filter's weight: their plain mean is the
/// filtered value, and no pixel needs another's samples: for pixels that are traced here and there.
/// Source: Ernst, Stamminger & Greiner,
/// "Filter importance sampling", IEEE Symposium on Interactive Ray Tracing 2006. They form a
/// sunflower head, each pixel's turned by an angle of its own: angles advance by the golden section
/// (Vogel, "A better way to construct the sunflower head", Mathematical Biosciences 44, 1979), and
/// the filter is divided into `count` rings of equal weight, from the centre out, each with one
/// sample at a random radius. The result is a pure function of the arguments.
/// @param sample  0 ... count - 1; sample 0 is nearest to the pixel's centre
/// @param jitter  uniform in [0, 1): where in its ring the sample lies
[[nodiscard]] PixelOffset pixel_sample(std::uint64_t seed, int x, int y, int sample, int count,
                                       double jitter);

}  // namespace lightwalk
