#pragma once
// Where glossy surfaces shine: how far the eye may move before their colour is another one.
#include "core/geometry/geometry.h"
#include "core/light/light_sources.h"

namespace lightwalk {

/// A rough specular lobe on top of a diffuse surface.
struct GlossyLobe {
    double rho = 0;      ///< specular reflectance
    double diffuse = 0;  ///< diffuse reflectance
    double alpha = 0;    ///< rms slope of the facets
};

/// The lights of a scene, as glossy surfaces see them. Immutable.
class Highlights {
  public:
    /// All must outlive this.
    Highlights(const LightSources& lights, const Geometry& geometry, const RenderOptions& options)
        : lights_(lights), geometry_(geometry), options_(options) {}

    /// How fast the colour at a hit changes as the ray turns about it: a tenth of it over the
    /// largest turn that changes what each light brings by no more [1/rad]. 0: it may turn as far
    /// as it likes. Light from elsewhere does not count: it makes colours steadier.
    [[nodiscard]] double slope(const Hit& hit, const Vec3& direction, const GlossyLobe& lobe) const;

  private:
    const LightSources& lights_;
    const Geometry& geometry_;
    const RenderOptions& options_;
};

}  // namespace lightwalk
