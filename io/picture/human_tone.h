#pragma once
// What a person would see: contrasts that are visible in the scene are visible on the screen, and
// no others. Source: Ward Larson, Rushmeier and Piatko, "A visibility matching tone reproduction
// operator for high dynamic range scenes", IEEE TVCG 3 (1997), pp. 291-306, without its glare and
// blur.
#include <vector>

#include "io/picture/brightness.h"

namespace lightwalk {

/// Smallest difference of luminance that is seen at adaptation to luminance L, both in cd/m².
/// Source: the paper's table 1, after Ferwerda et al., "A model of visual adaptation for realistic
/// image synthesis", SIGGRAPH 1996.
[[nodiscard]] double visible_difference(double L);

/// How far colours have faded to grey where luminance (cd/m²) is so low that rods see it: 1 from
/// 5.62 on, 0 up to 0.00562, linear in between. Source: the paper's section 5.4.
[[nodiscard]] double colour_sensitivity(double L);

/// From the luminance of the scene to that of a screen of 1 to 100 cd/m², as a share of 100.
/// Monotone.
class HumanTone {
  public:
    explicit HumanTone(const BrightnessHistogram& histogram);
    /// @param L  luminance in the scene [cd/m²]
    [[nodiscard]] double operator()(double L) const;

  private:
    void adjust(std::vector<double>& counts) const;

    bool linear_ = true;  ///< the screen can show the scene as it is, but for one factor
    double factor_ = 1;
    double lowest_ = 0, highest_ = 0;  ///< natural logarithms of the scene's luminance
    std::vector<double> shares_;       ///< of the pixels up to the ends of equal steps in between
};

}  // namespace lightwalk
