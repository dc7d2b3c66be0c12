#include "core/math/rgbe.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace lightwalk {
namespace {

constexpr double kBrightest = 0x1p127;  // what the largest exponent byte can't reach any more

double usable(float component) {
    if (std::isnan(component)) return 0;
    return std::fmin(static_cast<double>(component), kBrightest);
}

unsigned char mantissa(double component, double scale) {
    const double m = component * scale;
    return static_cast<unsigned char>(m > 0 ? std::fmin(m, 255) : 0);
}

}  // namespace

Rgbe encode_rgbe(const Rgb& color) {
    const double r = usable(color.r), g = usable(color.g), b = usable(color.b);
    const double largest = std::fmax(r, std::fmax(g, b));
    if (!(largest > 1e-32)) return {};
    int exponent = 127;
    if (largest < kBrightest) (void)std::frexp(largest, &exponent);
    const double scale = std::ldexp(1.0, 8 - exponent);
    return {mantissa(r, scale), mantissa(g, scale), mantissa(b, scale),
            static_cast<unsigned char>(exponent + 128)};
}

Rgb decode_rgbe(const Rgbe& pixel) {
    if (pixel.e == 0) return {};
    const auto scale =
        std::bit_cast<double>(std::uint64_t{pixel.e + 1023u - 136u} << 52);  // 2^(e - 136)
    return {static_cast<float>((pixel.r + 0.5) * scale),
            static_cast<float>((pixel.g + 0.5) * scale),
            static_cast<float>((pixel.b + 0.5) * scale)};
}

}  // namespace lightwalk
