#pragma once
// Highlights on glossy surfaces: how far the eye may move before their colour changes visibly.
#include "core/geometry/geometry.h"
#include "core/light/light_sources.h"

namespace lightwalk {

/// A rough specular lobe on top of a diffuse surface.
struct GlossyLobe {
    double rho = 0;      ///< specular reflectance
    double diffuse = 0;  ///< diffuse reflectance
    double alpha = 0;    ///< rms slope of the facets
};

/// Estimates how fast highlights of a scene's lights change with the view direction. Immutable.
class Highlights {
  public:
    /// All must outlive this.
    Highlights(const LightSources& lights, const Geometry& geometry, const RenderOptions& options)
        : lights_(lights), geometry_(geometry), options_(options) {}

    /// Relative change of the colour at a hit per angle by which the ray turns about it [1/rad]: a
    /// tenth, divided by the largest angle over which the contribution of no light changes by more
    /// than a tenth. 0 where that angle is unlimited. Conservative: other light, which is left out,
    /// makes relative changes smaller.
    [[nodiscard]] double slope(const Hit& hit, const Vec3& direction, const GlossyLobe& lobe) const;

  private:
    const LightSources& lights_;
    const Geometry& geometry_;
    const RenderOptions& options_;
};

}  // namespace lightwalk
