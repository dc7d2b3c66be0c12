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

/// How far the eye's ray may turn about a point that is lit by a light whose mirrored image it
/// misses, before the lobe's share of the colour has changed by a twentieth of it: by the Ward
/// lobe's exp(-δ²/α²), δ changing half as fast as the ray turns.
/// @param off     least angle between the normal and the half vectors of ray and light [rad]
/// @param alpha2  squared rms slope, widened by the light's size
/// @param peak    what the lobe brings where it is brightest, over what is diffuse
/// @return        0.003 ... 0.8 [rad]
[[nodiscard]] double steady_turn(double off, double alpha2, double peak);

/// The lights of a scene, as glossy surfaces see them. Immutable.
class Highlights {
  public:
    /// Both must outlive this.
    Highlights(const LightSources& lights, const RenderOptions& options)
        : lights_(lights), options_(options) {}

    /// The least steady_turn() of all lights at a hit, as a relative change of the colour per turn
    /// [1/rad]. Shadows do not count.
    [[nodiscard]] double slope(const Hit& hit, const Vec3& direction, const GlossyLobe& lobe) const;

  private:
    const LightSources& lights_;
    const RenderOptions& options_;
};

}  // namespace lightwalk
