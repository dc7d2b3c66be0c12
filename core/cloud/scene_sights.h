#pragma once
// What a ray sees of a scene, without shading it: surfaces, panes and mirrors on its way.
#include <vector>

#include "core/cloud/highlights.h"
#include "core/cloud/sight.h"
#include "core/transport/tracer.h"

namespace lightwalk {

/// What one modifier's surfaces look like.
struct SurfaceLook {
    Appearance appearance = Appearance::unknown;
    float gloss = 0, roughness = 0, diffuse = 0;  ///< see MaterialTraits
    bool textured = false;                        ///< normals are turned
    bool patterned = false;
};

/// Follows the light of a pixel back to where it comes from: straight through panes and surfaces
/// without material, along the reflection of flat mirrors. Whether the first surface mirrors
/// something is told beside what lies ahead. Immutable; many threads may ask.
///
/// Surfaces whose look nobody can tell are reused as long as the eye does not move: bent or curved
/// mirrors, materials given by functions, refraction. In scenes with antimatter or a medium nothing
/// is reused.
class SceneSights {
  public:
    /// The tracer must outlive this.
    explicit SceneSights(const Tracer& tracer);

    /// @param ray    the pixel's ray
    /// @param first  what it meets
    /// @param slopes  tell how steadily colours hold; else the slopes are only right where they are
    ///                kUnsteady, which is cheaper
    /// Sets all of `sights` but x and y.
    void find(const RaySegment& ray, const Hit& first, bool slopes, PixelSights& sights) const;

  private:
    /// A ray on its way.
    struct Walk {
        RaySegment segment;
        bool slopes = true;     ///< are asked for
        double length = 0;      ///< all the way so far [m]
        std::uint32_t met = 0;  ///< see Sight::surface
    };
    [[nodiscard]] SurfaceLook look_of(ModifierId modifier) const;
    [[nodiscard]] SurfaceLook look_at(const Hit& hit) const;
    [[nodiscard]] Hit next(Walk& walk, const Hit& hit, bool reflect) const;
    [[nodiscard]] bool reflects_flat(const Hit& hit, const SurfaceLook& look) const;
    void end(const RaySegment& ray, const Walk& walk, const Hit& hit, const SurfaceLook& look,
             Sight& sight) const;
    [[nodiscard]] float glossy_slope(const Walk& walk, const Hit& hit,
                                     const SurfaceLook& look) const;
    void follow(const RaySegment& ray, Walk walk, Hit hit, Sight& sight) const;
    [[nodiscard]] std::uint32_t background(const Walk& walk) const;

    const Tracer& tracer_;
    Highlights highlights_;
    std::vector<SurfaceLook> looks_;  ///< by modifier
    bool unsteady_ = false;           ///< all of the scene
};

}  // namespace lightwalk
