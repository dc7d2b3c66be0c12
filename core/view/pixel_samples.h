#pragma once
// Where the samples of a pixel lie: drawn from the pixel's filter.
#include <cstdint>

namespace lightwalk {

/// Offset from a pixel's centre [pixels], x to the right, y up.
struct PixelOffset {
    double x = 0, y = 0;
};

/// Radius of the pixel filter [pixels]: its weight at distance r is exp(-(r / 0.6)²) / (0.36 π). It
/// is the Gaussian that Radiance's `pfilt -r .6` filters with (the shape is that of its output for
/// a straight edge), so no second program is needed to average an oversized picture.
inline constexpr double kPixelFilterRadius = 0.6;

/// The samples of pixel (x, y), distributed as its filter's weight: their plain mean is the
/// filtered value, and no pixel needs another's samples. Source: Ernst, Stamminger & Greiner,
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
