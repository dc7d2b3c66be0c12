#pragma once
// How bright a picture is: what its display has to be set to.
#include <array>
#include <cstddef>
#include <span>

#include "core/math/rgb.h"

namespace lightwalk {

/// Counts of brightness in steps of an eighth of an octave, 2^-20 to 2^20 W/(m² sr); what is
/// beyond lies in the first and the last step. Pixels that are black or no numbers do not count.
class BrightnessHistogram {
  public:
    static constexpr int kStepsPerOctave = 8;
    static constexpr int kLowest = -20, kHighest = 20;  ///< octaves
    static constexpr std::size_t kSteps =
        static_cast<std::size_t>(kHighest - kLowest) * kStepsPerOctave;

    /// @param stride  only every so-manieth pixel is looked at
    explicit BrightnessHistogram(std::span<const Rgb> pixels, std::size_t stride = 1);

    [[nodiscard]] std::span<const double> counts() const { return counts_; }
    [[nodiscard]] double total() const { return total_; }
    /// Middle of a step [W/(m² sr)].
    [[nodiscard]] static double middle(std::size_t step);

    /// Mean of the logarithms, back as a brightness; 0 when nothing was counted [W/(m² sr)].
    [[nodiscard]] double log_average() const;
    /// What this share of the pixels stays below, by their largest channels; 0 when nothing was
    /// counted [W/(m² sr)].
    [[nodiscard]] double below_which(double share) const;

  private:
    std::array<double, kSteps> counts_{}, peaks_{};
    double total_ = 0, log_sum_ = 0;
};

}  // namespace lightwalk
