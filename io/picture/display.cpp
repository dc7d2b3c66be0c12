#include "io/picture/display.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/math/xyz.h"
#include "io/picture/human_tone.h"
#include "io/picture/tone.h"

namespace lightwalk {
namespace {

constexpr double kAdaptationTime = 0.4;  // [s]

// Tables by the upper bits of positive floats: 256 steps an octave.
constexpr unsigned kDropped = 15;
constexpr float kLeast = 0x1p-30f, kMost = 0x1p30f;

std::uint32_t place_of(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(std::clamp(value, kLeast, kMost));
    return (bits - std::bit_cast<std::uint32_t>(kLeast)) >> kDropped;
}

float value_at(std::size_t place) {
    const auto bits = static_cast<std::uint32_t>(place) << kDropped;
    return std::bit_cast<float>(bits + std::bit_cast<std::uint32_t>(kLeast) +
                                (1U << (kDropped - 1)));
}

/// sRGB bytes (IEC 61966-2-1) of 65536 equal steps from 0 to 1: near black a byte is 20 of them.
class SrgbTable {
  public:
    SrgbTable() {
        for (std::size_t i = 0; i < bytes_.size(); ++i) {
            const double x = static_cast<double>(i) / static_cast<double>(bytes_.size() - 1);
            const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
            bytes_[i] = static_cast<std::uint8_t>(std::lround(255 * y));
        }
    }
    [[nodiscard]] std::uint8_t operator()(float x) const {
        const float at = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(bytes_.size() - 1) + 0.5f;
        return bytes_[static_cast<std::size_t>(at)];
    }

  private:
    std::array<std::uint8_t, 65536> bytes_{};
};

const SrgbTable& srgb_table() {
    static const SrgbTable table;
    return table;
}

/// The value limited to 0 ... kBrightest; NaN becomes 0.
float shown_part(float value) {
    return value > 0 ? std::min(value, kBrightestShown) : 0.0f;
}

double polynomial(double x, std::initializer_list<double> coefficients) {
    double sum = 0, power = 1;
    for (const double c : coefficients) {
        sum += c * power;
        power *= x;
    }
    return std::clamp(sum, 0.0, 1.0);
}

}  // namespace

std::array<double, 3> scale_colour(double at) {
    const double x = std::clamp(at, 0.0, 1.0);
    return {
        polynomial(
            x, {0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943}),
        polynomial(x, {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604}),
        polynomial(
            x, {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973})};
}

void Adaptation::look_at(const BrightnessHistogram& picture, double seconds) {
    if (!(picture.total() > 0)) return;
    const double share = 1 - std::exp(-std::max(seconds, 0.0) / kAdaptationTime);
    const auto follow = [&](double from, double to) {
        return from > 0 ? from * std::pow(to / from, share) : to;  // the first look: at once
    };
    average_ = follow(average_, picture.log_average());
    white_ = follow(white_, picture.below_which(kShareBelowWhite));
}

Display::Display(const DisplaySettings& settings, const Adaptation& eye,
                 const BrightnessHistogram& picture)
    : settings_(settings) {
    exposure_ = !settings.automatic ? std::exp2(settings.ev)
                : eye.average() > 0 ? kMiddleGrey / eye.average()
                                    : 1;
    if (settings.false_colour) {
        colours_.resize(place_of(kMost) + 1);
        for (std::size_t i = 0; i < colours_.size(); ++i)
            colours_[i] = false_colour(double{kEfficacy} * static_cast<double>(value_at(i)));
        return;
    }
    if (settings.human) {
        const HumanTone tone(picture);
        fill_table([&](double L) -> Entry {
            const double grey = 1 - colour_sensitivity(double{kEfficacy} * L);
            return {static_cast<float>(tone(double{kEfficacy} * L) / L), 0,
                    static_cast<float>(grey)};
        });
        return;
    }
    constexpr double kFading = 0.03;  // see display_pixel()
    white_ = settings.automatic ? std::max(1.0, exposure_ * eye.white()) : 16;
    const HighlightCurve curve(white_);
    fill_table([&](double peak) -> Entry {
        const double before = exposure_ * peak, shown = curve(before);
        const double saturation = 1 / (1 + kFading * std::max(before - shown, 0.0));
        return {static_cast<float>(shown * saturation / peak),
                static_cast<float>(shown * (1 - saturation)), 0};
    });
}

template <class Make>
void Display::fill_table(Make make) {
    table_.resize(place_of(kMost) + 1);
    for (std::size_t i = 0; i < table_.size(); ++i)
        table_[i] = make(static_cast<double>(value_at(i)));
}

std::array<std::uint8_t, 3> Display::false_colour(double L) const {
    double at = (L - settings_.low) / (settings_.high - settings_.low);
    if (settings_.logarithmic)
        at = std::log(L / settings_.low) / std::log(settings_.high / settings_.low);
    std::array<std::uint8_t, 3> bytes{};
    const std::array<double, 3> colour = scale_colour(at);
    for (std::size_t k = 0; k < 3; ++k)
        bytes[k] = static_cast<std::uint8_t>(std::lround(255 * colour[k]));
    return bytes;
}

void Display::show_colours(std::span<const Rgb> pixels, std::span<std::uint8_t> bytes) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const std::array<std::uint8_t, 3>& colour =
            colours_[place_of(shown_part(brightness(pixels[i])))];
        std::copy(colour.begin(), colour.end(), &bytes[3 * i]);
    }
}

void Display::show(std::span<const Rgb> pixels, std::span<std::uint8_t> bytes) const {
    if (!colours_.empty()) return show_colours(pixels, bytes);
    const SrgbTable& srgb = srgb_table();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Rgb c{shown_part(pixels[i].r), shown_part(pixels[i].g), shown_part(pixels[i].b)};
        const float by = settings_.human ? brightness(c) : max_component(c);
        const Entry& entry = table_[place_of(by)];
        const float grey = entry.grey * brightness(c);
        for (std::size_t k = 0; k < 3; ++k)
            bytes[3 * i + k] = srgb(entry.factor * ((1 - entry.grey) * c[k] + grey) + entry.white);
    }
}

}  // namespace lightwalk
