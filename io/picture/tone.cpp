#include "io/picture/tone.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightwalk {
namespace {

constexpr double kKnee = 2 * kMiddleGrey;
constexpr double kFading = 0.03;

double srgb_curve(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

bool is_lit(const Rgb& pixel) {
    const float L = brightness(pixel);
    return L > 0 && std::isfinite(L);
}

double automatic_scale(const Picture& picture) {
    double sum = 0, count = 0;
    for (const Rgb& pixel : picture.pixels) {
        if (!is_lit(pixel)) continue;
        sum += std::log(static_cast<double>(brightness(pixel)));
        ++count;
    }
    return count > 0 ? kMiddleGrey / std::exp(sum / count) : 1;
}

double automatic_white(const Picture& picture, double scale) {
    std::vector<float> peaks;
    peaks.reserve(picture.pixels.size());
    for (const Rgb& pixel : picture.pixels) {
        if (is_lit(pixel)) peaks.push_back(max_component(pixel));
    }
    if (peaks.empty()) return 1;
    const auto below =
        static_cast<std::ptrdiff_t>(kShareBelowWhite * static_cast<double>(peaks.size()));
    const auto at = peaks.begin() + below;
    std::nth_element(peaks.begin(), at, peaks.end());
    return std::max(1.0, scale * static_cast<double>(*at));
}

/// From the knee to 1 in units of the room that it leaves: 0 to 1 for the display's own range.
double above_knee(double x) {
    return (x - kKnee) / (1 - kKnee);
}

/// The c > 0 with c = log(1 + c w), where w > 1: by bisection, since the difference is positive
/// below it and negative above, up to 2 w at least. With w = 1 there is none but 0: the least value
/// tried, with which the curve is straight to nine digits.
double steepness(double w) {
    double below = 1e-9, above = 2 * w;
    for (int i = 0; i < 100; ++i) {
        const double c = 0.5 * (below + above);
        (std::log1p(c * w) > c ? below : above) = c;
    }
    return below;
}

/// Display values of an exposed colour, each 0 to 1.
std::array<double, 3> compress(const std::array<double, 3>& exposed, const HighlightCurve& curve) {
    const double peak = *std::max_element(exposed.begin(), exposed.end());
    if (!(peak > 0)) return {};
    const double shown = curve(peak);
    const double saturation = 1 / (1 + kFading * std::max(peak - shown, 0.0));
    std::array<double, 3> result{};
    for (std::size_t k = 0; k < 3; ++k)
        result[k] = shown * (1 - saturation + saturation * (exposed[k] / peak));
    return result;
}

}  // namespace

HighlightCurve::HighlightCurve(double white) : white_(white), c_(steepness(above_knee(white))) {}

double HighlightCurve::operator()(double x) const {
    if (x <= kKnee) return x;
    if (x >= white_) return 1;
    return std::min(kKnee + (1 - kKnee) * std::log1p(c_ * above_knee(x)) / c_, 1.0);
}

DisplayTone choose_tone(const Picture& picture, const ToneMapping& tone) {
    DisplayTone chosen;
    chosen.scale = tone.automatic ? automatic_scale(picture) : std::exp2(tone.ev);
    if (tone.curve == ToneCurve::linear)
        chosen.curve.reset();
    else if (tone.automatic)
        chosen.curve = HighlightCurve(automatic_white(picture, chosen.scale));
    return chosen;
}

std::array<std::uint8_t, 3> display_pixel(const Rgb& color, const DisplayTone& tone) {
    std::array<double, 3> values{};
    for (std::size_t k = 0; k < 3; ++k) {
        if (color[k] > 0)
            values[k] = static_cast<double>(std::min(color[k], kBrightestShown)) * tone.scale;
    }
    if (tone.curve) values = compress(values, *tone.curve);
    std::array<std::uint8_t, 3> bytes{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double byte = 255 * srgb_curve(std::min(values[k], 1.0));
        bytes[k] = static_cast<std::uint8_t>(std::lround(byte));
    }
    return bytes;
}

std::vector<std::array<std::uint8_t, 3>> display_pixels(const Picture& picture,
                                                        const DisplayTone& tone) {
    std::vector<std::array<std::uint8_t, 3>> pixels;
    pixels.reserve(picture.pixels.size());
    for (const Rgb& color : picture.pixels) pixels.push_back(display_pixel(color, tone));
    return pixels;
}

}  // namespace lightwalk
