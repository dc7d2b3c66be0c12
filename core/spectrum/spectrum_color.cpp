#include "core/spectrum/spectrum_color.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/math/xyz.h"
#include "core/spectrum/cie_observer.h"

namespace lightwalk {
namespace {

constexpr double kShortestVisible = 380, kLongestVisible = 780;  // [nm]

/// What equal energy between two wavelengths gives in X, Y and Z.
std::array<double, 3> observer_between(double low, double high) {
    const std::array<double, 3> below = observer_below(low);
    std::array<double, 3> share = observer_below(high);
    for (std::size_t c = 0; c < 3; ++c) share[c] -= below[c];
    return share;
}

}  // namespace

Rgb color_from_xyz(const std::array<double, 3>& xyz) {
    const auto photometric = [](double v) { return static_cast<float>(v * double{kEfficacy}); };
    const Rgb color = from_xyz({photometric(xyz[0]), photometric(xyz[1]), photometric(xyz[2])});
    const auto grey = static_cast<float>(xyz[1]);
    if (!(grey > 0)) return {};
    const float least = min_component(color);
    if (least >= 0) return color;
    const float kept = grey / (grey - least);
    Rgb mixed;
    for (std::size_t c = 0; c < 3; ++c)
        mixed[c] = std::max(0.0f, kept * color[c] + (1 - kept) * grey);
    return mixed;
}

WavelengthEnds ends_of_samples(double first, double last, std::size_t count) {
    const double half = (last - first) / (2 * static_cast<double>(count - 1));
    return {first - half, last + half};
}

SpectrumColor::SpectrumColor(WavelengthEnds ends, std::size_t bands) : weights_(bands) {
    assert(bands > 0);
    if (ends.first > ends.last && bands <= kMostSpectralBands) {
        weigh(ends);
        return;
    }
    const double width = std::abs(ends.last - ends.first);
    const double wanted = std::floor(
        (kLongestVisible - kShortestVisible) * static_cast<double>(bands) / width + 0.99);
    weigh_resampled(ends, static_cast<std::size_t>(
                              std::clamp(wanted, 1.0, static_cast<double>(kMostSpectralBands))));
}

void SpectrumColor::weigh(WavelengthEnds ends) {
    channels_ = weights_.size() == 3;
    const double step = (ends.first - ends.last) / static_cast<double>(weights_.size());
    for (std::size_t i = 0; i < weights_.size(); ++i) {
        if (channels_) {
            weights_[i][i] = 1;
        } else {
            const double high = ends.first - step * static_cast<double>(i);
            weights_[i] = observer_between(ends.first - step * static_cast<double>(i + 1), high);
        }
    }
}

/// Every band counts in each of the new ones by the part of the new one that it covers.
void SpectrumColor::weigh_resampled(WavelengthEnds ends, std::size_t into) {
    channels_ = into == 3;
    const double step = (ends.last - ends.first) / static_cast<double>(weights_.size());
    const double width = (kLongestVisible - kShortestVisible) / static_cast<double>(into);
    for (std::size_t k = 0; k < into; ++k) {
        const double low = kShortestVisible + width * static_cast<double>(k), high = low + width;
        std::array<double, 3> share{};
        if (channels_) {
            share[2 - k] = 1;  // red is the longest
        } else {
            share = observer_between(low, high);
        }
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            const double a = ends.first + step * static_cast<double>(i), b = a + step;
            const double common = std::min(high, std::max(a, b)) - std::max(low, std::min(a, b));
            for (std::size_t c = 0; c < 3 && common > 0; ++c)
                weights_[i][c] += share[c] * common / width;
        }
    }
}

Rgb SpectrumColor::Sum::color() const {
    if (!of_.channels_) return color_from_xyz(sum_);
    return {static_cast<float>(sum_[0]), static_cast<float>(sum_[1]), static_cast<float>(sum_[2])};
}

Rgb SpectrumColor::operator()(std::span<const double> values) const {
    assert(values.size() == weights_.size());
    Sum sum(*this);
    for (std::size_t i = 0; i < values.size(); ++i) sum.add(i, values[i]);
    return sum.color();
}

}  // namespace lightwalk
