#include "core/math/rgbe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lightwalk {
namespace {

constexpr double kBrightest = 0x1p127;  // what the largest exponent byte can't reach any more

double usable(float component) {
    const auto c = static_cast<double>(component);
    return c < kBrightest ? c : std::isnan(c) ? 0 : kBrightest;
}

unsigned char mantissa(double component, double scale) {
    return static_cast<unsigned char>(
        static_cast<int>(std::min(std::max(component * scale, 0.0), 255.0)));
}

/// 2^exponent of a normal number.
double power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

}  // namespace

Rgbe encode_rgbe(const Rgb& color) {
    const double r = usable(color.r), g = usable(color.g), b = usable(color.b);
    const double gb = g > b ? g : b, largest = r > gb ? r : gb;
    if (!(largest > 1e-32)) return {};
    // The exponent of a mantissa in [.5, 1): pictures are encoded by one thread, so without calls.
    const int exponent = largest < kBrightest
                             ? static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52) - 1022
                             : 127;
    const double scale = power_of_two(8 - exponent);
    return {mantissa(r, scale), mantissa(g, scale), mantissa(b, scale),
            static_cast<unsigned char>(exponent + 128)};
}

Rgb decode_rgbe(const Rgbe& pixel) {
    if (pixel.e == 0) return {};
    const double scale = power_of_two(pixel.e - 136);
    return {static_cast<float>((pixel.r + 0.5) * scale),
            static_cast<float>((pixel.g + 0.5) * scale),
            static_cast<float>((pixel.b + 0.5) * scale)};
}

}  // namespace lightwalk
