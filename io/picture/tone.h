#pragma once
// From radiance to what a screen shows: exposure, a curve for the highlights, sRGB.
#include <array>
#include <cstdint>
#include <optional>

#include "core/math/rgb.h"
#include "io/picture/picture.h"

namespace lightwalk {

/// What becomes of values beyond a display's range.
enum class ToneCurve {
    highlights,  ///< they are compressed smoothly, so that windows and lamps keep their drawing
    linear,      ///< they are cut off at white
};

/// How a picture is shown on a screen, as asked for.
struct ToneMapping {
    /// Log-average at middle grey (18 %), and the curve's white where the picture's is; otherwise a
    /// fixed exposure and a fixed curve, the same for all pictures of a sequence.
    bool automatic = true;
    double ev = 0;  ///< when not automatic [stops]: radiance 2^-ev W/(m² sr) becomes 1
    ToneCurve curve = ToneCurve::highlights;
};

/// Compresses what is brighter than a stop above middle grey so that `white` becomes 1.
class HighlightCurve {
  public:
    explicit HighlightCurve(double white);  ///< >= 1, of values that are exposed

    [[nodiscard]] double white() const { return white_; }
    /// x itself up to 0.36, the knee. The part above it, u, counted like white's, w, in units of
    /// the room that the knee leaves, becomes log(1 + c u) / log(1 + c w): Drago et al., "Adaptive
    /// logarithmic mapping for displaying high contrast scenes", Eurographics 2003, eq. 1, in the
    /// unit of light 1 / c in which it begins with slope 1. It rises up to white, where it reaches
    /// 1, and is 1 beyond; with white at 1 it changes nothing. x >= 0.
    [[nodiscard]] double operator()(double x) const;

  private:
    double white_;
    double c_;  ///< c = log(1 + c w)
};

/// How one picture is shown.
struct DisplayTone {
    double scale = 1;  ///< from radiance to display values, exposed but not yet compressed
    std::optional<HighlightCurve> curve = HighlightCurve(16);  ///< nothing: cut off at 1
};

/// Settle exposure and white for a picture. Automatic: the log-average of the brightness, without
/// pixels that have no light, becomes 18 % (Reinhard et al., "Photographic tone reproduction for
/// digital images", SIGGRAPH 2002, eqs. 1 and 2); white is the largest channel that 999 of 1000
/// such pixels stay below, and never less than 1, so that a picture without highlights is not
/// changed by the curve. Fixed: white lies four stops above the display's.
[[nodiscard]] DisplayTone choose_tone(const Picture& picture, const ToneMapping& tone);

/// sRGB bytes r, g, b of one pixel. The curve acts on the largest channel and the others follow in
/// proportion, which keeps hue and lets no channel clip; the more a colour is compressed, the more
/// it fades to white, by the share 1 - 1 / (1 + 0.03 (before - after)): the form of Khronos Group,
/// "PBR Neutral Tone Mapper" (2024), with 0.03 for 0.15, since this curve compresses sooner. Then
/// the sRGB curve (IEC 61966-2-1). Radiance's white is shown as the display's white; negative
/// channels and those that are not numbers count as 0.
[[nodiscard]] std::array<std::uint8_t, 3> display_pixel(const Rgb& color, const DisplayTone& tone);

}  // namespace lightwalk
