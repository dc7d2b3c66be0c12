#pragma once
// The histogram of a picture's brightness, from which exposure is chosen.
#include <array>
#include <cstddef>
#include <span>

#include "core/math/rgb.h"

namespace lightwalk {

/// Counts of brightness in steps of an eighth of an octave, 2^-20 to 2^20 W/(m² sr); darker and
/// brighter pixels are counted in the first and the last step, black ones and NaN not at all.
class BrightnessHistogram {
  public:
    static constexpr int kStepsPerOctave = 8;
    static constexpr int kLowest = -20, kHighest = 20;  ///< octaves
    static constexpr std::size_t kSteps =
        static_cast<std::size_t>(kHighest - kLowest) * kStepsPerOctave;

    /// @param stride  only every stride-th pixel is counted
    explicit BrightnessHistogram(std::span<const Rgb> pixels, std::size_t stride = 1);

    [[nodiscard]] std::span<const double> counts() const { return counts_; }
    [[nodiscard]] double total() const { return total_; }
    /// The brightness at the middle of a step [W/(m² sr)].
    [[nodiscard]] static double middle(std::size_t step);

    /// The geometric mean of the brightness [W/(m² sr)]; 0 when nothing was counted.
    [[nodiscard]] double log_average() const;
    /// The quantile `share` of the pixels' largest channels [W/(m² sr)]; 0 when nothing was
    /// counted.
    [[nodiscard]] double below_which(double share) const;

  private:
    std::array<double, kSteps> counts_{}, peaks_{};
    double total_ = 0, log_sum_ = 0;
};

}  // namespace lightwalk
