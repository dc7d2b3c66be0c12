#pragma once
// Tone mapping that models human vision: contrasts that are visible in the scene are visible on the
// screen, and no others. Source: Ward Larson, Rushmeier and Piatko, "A visibility matching tone
// reproduction operator for high dynamic range scenes", IEEE TVCG 3 (1997), pp. 291-306, without
// its glare and blur.
#include <vector>

#include "io/picture/brightness.h"

namespace lightwalk {

/// The smallest visible difference of luminance at adaptation to luminance L, both in cd/m².
/// Source: the paper's table 1, after Ferwerda et al., "A model of visual adaptation for realistic
/// image synthesis", SIGGRAPH 1996.
[[nodiscard]] double visible_difference(double L);

/// The saturation of colours at luminance L [cd/m²]: 1 (cones see) from 5.62 on, 0 (rods see) up
/// to 0.00562, linear in between. Source: the paper's section 5.4.
[[nodiscard]] double colour_sensitivity(double L);

/// The monotone map from luminance of the scene to luminance of a screen of 1 to 100 cd/m², as a
/// share of 100.
class HumanTone {
  public:
    explicit HumanTone(const BrightnessHistogram& histogram);
    /// @param L  luminance in the scene [cd/m²]
    [[nodiscard]] double operator()(double L) const;

  private:
    void adjust(std::vector<double>& counts) const;

    bool linear_ = true;  ///< the screen can show the range of the scene, so one factor is enough
    double factor_ = 1;
    double lowest_ = 0, highest_ = 0;  ///< natural logarithms of the scene's luminance
    std::vector<double> shares_;       ///< cumulative distribution, at equal steps in between
};

}  // namespace lightwalk
