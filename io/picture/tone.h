#pragma once
// Tone mapping from radiance to a screen: exposure, a curve for the highlights, sRGB.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/rgb.h"
#include "io/picture/picture.h"

namespace lightwalk {

/// What automatic exposure shows a picture's log-average as, and the share of its pixels that the
/// curve keeps below white.
inline constexpr double kMiddleGrey = 0.18, kShareBelowWhite = 0.999;
/// Values above this one, infinity among them, are shown as it is.
inline constexpr float kBrightestShown = 1e30f;

/// How values beyond the display's range are shown.
enum class ToneCurve {
    highlights,  ///< compressed smoothly, so that windows and lamps keep visible detail
    linear,      ///< clipped to white
};

/// The tone mapping that was asked for, independent of a picture.
struct ToneMapping {
    /// true: the picture's log-average is shown as middle grey (18 %), and its white determines the
    /// curve. false: exposure and curve are fixed, the same for all pictures of a sequence.
    bool automatic = true;
    double ev = 0;  ///< exposure when not automatic [stops]: radiance 2^-ev W/(m² sr) becomes 1
    ToneCurve curve = ToneCurve::highlights;
};

/// A curve that compresses values brighter than a stop above middle grey so that `white` becomes 1.
class HighlightCurve {
  public:
    /// @param white  the value, after exposure, that becomes 1; at least 1
    explicit HighlightCurve(double white);

    [[nodiscard]] double white() const { return white_; }
    /// The value shown for x >= 0. Up to the knee at 0.36 it is x. Above, with u and w the parts of
    /// x and white above the knee, in units of 1 - 0.36, the part above the knee becomes log(1 + c
    /// u) / log(1 + c w), with c such that the slope is 1 at the knee. Source: Drago et al.,
    /// "Adaptive logarithmic mapping for displaying high contrast scenes", Eurographics 2003,
    /// eq. 1. The result is 1 from white on. With white = 1 nothing is compressed.
    [[nodiscard]] double operator()(double x) const;

  private:
    double white_;
    double c_;  ///< c = log(1 + c w)
};

/// Exposure and curve of one picture.
struct DisplayTone {
    double scale = 1;  ///< factor from radiance to exposed values, before the curve
    std::optional<HighlightCurve> curve = HighlightCurve(16);  ///< nothing: values are clipped at 1
};

/// Choose exposure and white for a picture. Automatic: the log-average of the brightness of all
/// pixels that are not black becomes 18 % (Reinhard et al., "Photographic tone reproduction for
/// digital images", SIGGRAPH 2002, eqs. 1 and 2); white is the largest channel that 999 of 1000 of
/// these pixels stay below, and at least 1, so that the curve does not change a picture without
/// highlights. Fixed: white is four stops above the display's white.
[[nodiscard]] DisplayTone choose_tone(const Picture& picture, const ToneMapping& tone);

/// sRGB bytes r, g, b of one pixel. The curve is applied to the largest channel and the others are
/// scaled in proportion, which keeps the hue and clips no channel. The more a colour is compressed,
/// the more it fades to white, by the share 1 - 1 / (1 + 0.03 (before - after)): the form of
/// Khronos Group, "PBR Neutral Tone Mapper" (2024), with 0.03 instead of 0.15, as this curve
/// compresses from lower values on. Then follows the sRGB curve (IEC 61966-2-1). Radiance's white
/// is shown as the display's white; negative channels and NaN count as 0.
[[nodiscard]] std::array<std::uint8_t, 3> display_pixel(const Rgb& color, const DisplayTone& tone);
/// Those of all pixels of a picture.
[[nodiscard]] std::vector<std::array<std::uint8_t, 3>> display_pixels(const Picture& picture,
                                                                      const DisplayTone& tone);

}  // namespace lightwalk
