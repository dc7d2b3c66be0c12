#include "io/picture/brightness.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

std::size_t step_of(float value) {
    const double step = (std::log2(static_cast<double>(value)) - BrightnessHistogram::kLowest) *
                        BrightnessHistogram::kStepsPerOctave;
    return static_cast<std::size_t>(
        std::clamp(step, 0.0, static_cast<double>(BrightnessHistogram::kSteps - 1)));
}

}  // namespace

BrightnessHistogram::BrightnessHistogram(std::span<const Rgb> pixels, std::size_t stride) {
    for (std::size_t i = 0; i < pixels.size(); i += stride) {
        const float L = brightness(pixels[i]);
        if (!(L > 0) || !std::isfinite(L)) continue;
        ++counts_[step_of(L)];
        ++peaks_[step_of(max_component(pixels[i]))];
        ++total_;
        log_sum_ += std::log(static_cast<double>(L));
    }
}

double BrightnessHistogram::middle(std::size_t step) {
    return std::exp2(kLowest + (static_cast<double>(step) + 0.5) / kStepsPerOctave);
}

double BrightnessHistogram::log_average() const {
    return total_ > 0 ? std::exp(log_sum_ / total_) : 0;
}

double BrightnessHistogram::below_which(double share) const {
    if (!(total_ > 0)) return 0;
    double sum = 0;
    for (std::size_t step = 0; step < kSteps; ++step) {
        sum += peaks_[step];
        // The upper end of the step.
        if (sum > share * total_)
            return std::exp2(kLowest + static_cast<double>(step + 1) / kStepsPerOctave);
    }
    return std::exp2(kHighest);
}

}  // namespace lightwalk
