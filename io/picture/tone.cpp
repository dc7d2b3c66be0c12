#include <algorithm>
#include <cmath>

#include "io/picture/picture.h"

namespace lightwalk {
namespace {

constexpr double kMiddleGrey = 0.18;
constexpr double kKnee = 0.6;  // display values above it are compressed

/// Identity below the knee, then an exponential towards 1 that joins with slope 1.
double shoulder(double x) {
    constexpr double kRoom = 1 - kKnee;
    return x <= kKnee ? x : kKnee + kRoom * (1 - std::exp((kKnee - x) / kRoom));
}

double srgb_curve(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

}  // namespace

double display_scale(const Picture& picture, const ToneMapping& tone) {
    if (!tone.automatic) return std::exp2(tone.ev);
    double sum = 0, count = 0;
    for (const Rgb& pixel : picture.pixels) {
        const auto L = static_cast<double>(brightness(pixel));
        if (!(L > 0 && std::isfinite(L))) continue;
        sum += std::log(L);
        ++count;
    }
    return count > 0 ? kMiddleGrey / std::exp(sum / count) : 1;
}

std::array<std::uint8_t, 3> display_pixel(const Rgb& color, double scale) {
    std::array<std::uint8_t, 3> bytes{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double x = static_cast<double>(color[k]) * scale;
        if (x > 0) bytes[k] = static_cast<std::uint8_t>(std::lround(255 * srgb_curve(shoulder(x))));
    }
    return bytes;
}

}  // namespace lightwalk
