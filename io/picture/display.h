#pragma once
// How radiance becomes the colours of a screen, many pixels at a time.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/math/rgb.h"
#include "io/picture/brightness.h"

namespace lightwalk {

/// What the viewer asks for.
struct DisplaySettings {
    enum class Mode : std::uint8_t {
        tone,          ///< as on a photograph, or to a person's eye
        false_colour,  ///< luminance as colours of a scale
    };
    Mode mode = Mode::tone;
    bool automatic = true;  ///< exposure follows what is looked at
    double ev = 0;          ///< when not automatic [stops]: radiance 2^-ev W/(m² sr) becomes 1
    bool human = false;     ///< tone: what a person would see (see HumanTone)
    // False colour: ends of the scale [cd/m²], 0 < low < high when it is logarithmic.
    double low = 1, high = 10000;
    bool logarithmic = true;
    friend bool operator==(const DisplaySettings&, const DisplaySettings&) = default;
};

/// Eyes take a moment to get used to light: exposure follows what the pictures call for.
class Adaptation {
  public:
    /// The next picture, so long after the one before.
    void look_at(const BrightnessHistogram& picture, double seconds);

    [[nodiscard]] double average() const { return average_; }  ///< [W/(m² sr)], 0: no light yet
    [[nodiscard]] double white() const { return white_; }      ///< brightest worth drawing

  private:
    double average_ = 0, white_ = 0;
};

/// The colours of one picture. A pixel's bytes are a function of its radiance alone; many threads
/// may ask.
class Display {
  public:
    /// @param picture  for human vision; otherwise what the eye is adapted to tells
    Display(const DisplaySettings& settings, const Adaptation& eye,
            const BrightnessHistogram& picture);

    /// sRGB bytes r, g, b of each pixel; bytes.size() is three times that of pixels. Within one
    /// step of display_pixel() where that has the same tone.
    void show(std::span<const Rgb> pixels, std::span<std::uint8_t> bytes) const;

    /// From radiance to display values before any curve.
    [[nodiscard]] double exposure() const { return exposure_; }

  private:
    struct Entry {
        float factor = 1;  ///< of the colour
        float white = 0;   ///< added to all channels
        float grey = 0;    ///< share of it that is shown without colour
    };
    template <class Make>
    void fill_table(Make make);
    [[nodiscard]] std::array<std::uint8_t, 3> false_colour(double L) const;
    void show_colours(std::span<const Rgb> pixels, std::span<std::uint8_t> bytes) const;

    DisplaySettings settings_;
    double exposure_ = 1;
    std::vector<Entry> table_;  ///< by brightness, or by the largest channel
    std::vector<std::array<std::uint8_t, 3>> colours_;  ///< false ones, by brightness
};

/// The colour of a place on the scale, 0 ... 1, as sRGB values 0 ... 1. Source: Mikhailov,
/// "Turbo, an improved rainbow colormap for visualization", Google Research (2019); its
/// approximation by polynomials.
[[nodiscard]] std::array<double, 3> scale_colour(double at);

}  // namespace lightwalk
