#pragma once
// Conversion of radiance to the colours of a screen, many pixels at a time, with a state of
// adaptation.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/math/rgb.h"
#include "io/picture/brightness.h"

namespace lightwalk {

/// The settings that a viewer chooses.
struct DisplaySettings {
    /// Luminance as colours of a scale; false: as on a photograph, or to a person's eye.
    bool false_colour = false;
    bool automatic = true;  ///< exposure adapts to the pictures
    double ev = 0;          ///< when not automatic [stops]: radiance 2^-ev W/(m² sr) becomes 1
    bool human = false;     ///< tone mapping that models human vision (see HumanTone)
    // The ends of the scale of false colours [cd/m²]; 0 < low < high when it is logarithmic.
    double low = 1, high = 10000;
    bool logarithmic = true;
    friend bool operator==(const DisplaySettings&, const DisplaySettings&) = default;
};

/// Models the adaptation of the eye: exposure follows the brightness of the pictures with a delay.
class Adaptation {
  public:
    /// Adapt to the next picture, `seconds` after the previous one.
    void look_at(const BrightnessHistogram& picture, double seconds);

    [[nodiscard]] double average() const { return average_; }  ///< [W/(m² sr)]; 0 before any light
    [[nodiscard]] double white() const { return white_; }      ///< shown as white [W/(m² sr)]

  private:
    double average_ = 0, white_ = 0;
};

/// The colours of one picture. The bytes of a pixel depend on its radiance only, so threads may
/// convert parts of the picture at the same time.
class Display {
  public:
    /// @param picture  used for human vision only; otherwise `eye` determines the exposure
    Display(const DisplaySettings& settings, const Adaptation& eye,
            const BrightnessHistogram& picture);

    /// Write sRGB bytes r, g, b of each pixel; bytes.size() is 3 pixels.size(). They differ by at
    /// most one step from those of display_pixel() with the same tone.
    void show(std::span<const Rgb> pixels, std::span<std::uint8_t> bytes) const;

    /// The factor from radiance to display values, before any curve.
    [[nodiscard]] double exposure() const { return exposure_; }
    /// What HighlightCurve makes 1, after exposure; 0 for colours that it does not make: those of
    /// human vision and false ones.
    [[nodiscard]] double white() const { return white_; }

  private:
    struct Entry {
        float factor = 1;  ///< that the colour is multiplied by
        float white = 0;   ///< added to all channels
        float grey = 0;    ///< share of the brightness that is shown without colour
    };
    template <class Make>
    void fill_table(Make make);
    [[nodiscard]] std::array<std::uint8_t, 3> false_colour(double L) const;
    void show_colours(std::span<const Rgb> pixels, std::span<std::uint8_t> bytes) const;

    DisplaySettings settings_;
    double exposure_ = 1, white_ = 0;
    std::vector<Entry> table_;  ///< indexed by brightness, or by the largest channel
    std::vector<std::array<std::uint8_t, 3>> colours_;  ///< false colours, indexed by brightness
};

/// The colour at the place `at` (0 to 1) on the scale, as sRGB values 0 to 1. Source: Mikhailov,
/// "Turbo, an improved rainbow colormap for visualization", Google Research (2019); its
/// approximation by polynomials.
[[nodiscard]] std::array<double, 3> scale_colour(double at);

}  // namespace lightwalk
