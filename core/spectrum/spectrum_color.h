#pragma once
// Spectra as three-channel colours in Radiance's standard primaries.
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/math/rgb.h"

namespace lightwalk {

/// The most bands into which a spectrum is divided.
inline constexpr std::size_t kMostSpectralBands = 24;

/// A colour from CIE XYZ whose Y has the unit of the result. Colours outside the triangle of the
/// primaries are mixed with as much grey of the same Y as makes no channel negative.
[[nodiscard]] Rgb color_from_xyz(const std::array<double, 3>& xyz);

/// The ends of evenly spaced wavelengths, each of which stands for an interval of the same width
/// about it [nm].
struct WavelengthEnds {
    double first = 0, last = 0;  ///< edges of the first and of the last interval
};
/// The ends where `count` >= 2 values stand at wavelengths from `first` to `last`, both included.
[[nodiscard]] WavelengthEnds ends_of_samples(double first, double last, std::size_t count);

/// How spectra of a number of bands become colours. Immutable.
/// Spectra from long to short wavelengths in at most 24 bands are taken as they are; all others as
/// the means over at most 24 bands from 380 to 780 nm. Three bands that are given, or that come out
/// of it, are not taken for a spectrum: they are red, green and blue. As in Radiance's mode of
/// three channels.
class SpectrumColor {
  public:
    /// @param ends   edges of the bands [nm], either way round
    /// @param bands  their number, at least 1
    SpectrumColor(WavelengthEnds ends, std::size_t bands);
    /// A spectrum whose bands are given one by one.
    class Sum {
      public:
        explicit Sum(const SpectrumColor& of) : of_(of) {}
        void add(std::size_t band, double value) {
            for (std::size_t c = 0; c < 3; ++c) sum_[c] += value * of_.weights_[band][c];
        }
        [[nodiscard]] Rgb color() const;

      private:
        const SpectrumColor& of_;
        std::array<double, 3> sum_{};
    };
    /// @param values  one a band, in the order of the edges
    [[nodiscard]] Rgb operator()(std::span<const double> values) const;
    [[nodiscard]] std::size_t bands() const { return weights_.size(); }

  private:
    void weigh(WavelengthEnds ends);
    void weigh_resampled(WavelengthEnds ends, std::size_t into);

    std::vector<std::array<double, 3>> weights_;  ///< of each band in X, Y, Z, or in r, g, b
    bool channels_ = false;                       ///< the weights are those of r, g, b
};

}  // namespace lightwalk
