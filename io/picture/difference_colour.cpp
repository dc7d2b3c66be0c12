#include "io/picture/difference_colour.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lightwalk {
namespace {

constexpr double kEven = 0.1, kOctaves = 4;  // see difference_place()

// From less to more, at even distances: two hues that people of any colour vision tell apart.
constexpr std::array<std::array<double, 3>, 7> kStops{{{103, 169, 255},
                                                       {33, 102, 203},
                                                       {40, 70, 118},
                                                       {62, 62, 64},
                                                       {133, 72, 26},
                                                       {217, 108, 14},
                                                       {255, 201, 74}}};

// Ratios by the upper bits of positive floats: 256 steps an octave.
constexpr unsigned kRatioDropped = 15;
constexpr float kLeastRatio = 0x1p-5f, kMostRatio = 0x1p5f;

std::size_t ratio_index(float ratio) {
    const auto bits = std::bit_cast<std::uint32_t>(std::clamp(ratio, kLeastRatio, kMostRatio));
    const std::uint32_t half = 1U << (kRatioDropped - 1);  // a ratio of 1 is the middle of its step
    return (bits + half - std::bit_cast<std::uint32_t>(kLeastRatio)) >> kRatioDropped;
}

const std::vector<std::array<std::uint8_t, 3>>& ratio_colours() {
    static const std::vector<std::array<std::uint8_t, 3>> table = [] {
        std::vector<std::array<std::uint8_t, 3>> colours(ratio_index(kMostRatio) + 1);
        for (std::size_t i = 0; i < colours.size(); ++i) {
            const auto bits = std::bit_cast<std::uint32_t>(kLeastRatio) +
                              (static_cast<std::uint32_t>(i) << kRatioDropped);
            colours[i] = difference_colour_at(difference_place(1, std::bit_cast<float>(bits)));
        }
        return colours;
    }();
    return table;
}

}  // namespace

double difference_place(float before, float now) {
    if (before == now || std::isnan(before) || std::isnan(now)) return 0;
    if (!(before > 0)) return now > 0 ? 1 : 0;
    if (!(now > 0)) return -1;
    const double r = std::log2(static_cast<double>(now) / static_cast<double>(before));
    const double place = std::log1p(std::abs(r) / kEven) / std::log1p(kOctaves / kEven);
    return std::copysign(std::min(place, 1.0), r);
}

std::array<std::uint8_t, 3> difference_colour_at(double place) {
    constexpr double kSteps = kStops.size() - 1;
    const double at = (std::clamp(place, -1.0, 1.0) + 1) / 2 * kSteps;
    const auto first = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k)
        colour[k] = static_cast<std::uint8_t>(std::lround(
            std::lerp(kStops[first][k], kStops[first + 1][k], at - static_cast<double>(first))));
    return colour;
}

std::array<std::uint8_t, 3> difference_colour(float before, float now) {
    const float ratio = now / before;
    if (before > 0 && now > 0 && !std::isnan(ratio)) return ratio_colours()[ratio_index(ratio)];
    return difference_colour_at(difference_place(before, now));
}

}  // namespace lightwalk
