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

    /// Memory of searches, for the next ones. Each thread has its own.
    class Scratch;

    /// @param rays    the pixels'
    /// @param first   what each meets
    /// @param slopes  tell how steadily colours hold; else the slopes are only right where they are
    ///                kUnsteady, which is cheaper
    /// @param sights  of each ray; all but x and y are set, where `ray` says that there is one
    void find(std::span<const RaySegment> rays, std::span<const Hit> first, bool slopes,
              std::span<PixelSights> sights, Scratch& scratch) const;

  private:
    struct Walk;
    [[nodiscard]] SurfaceLook look_of(ModifierId modifier) const;
    [[nodiscard]] SurfaceLook look_at(const Hit& hit) const;
    [[nodiscard]] bool reflects_flat(const Hit& hit, const SurfaceLook& look) const;
    void end(const Walk& walk, const Hit& hit, const SurfaceLook& look) const;
    [[nodiscard]] float glossy_slope(const Walk& walk, const Hit& hit,
                                     const SurfaceLook& look) const;
    [[nodiscard]] bool goes_on(Walk& walk, const Hit& hit) const;
    [[nodiscard]] bool begins(Walk& walk, const Hit& hit, std::vector<Walk>& images) const;
    void follow(std::vector<Walk>& walks, Scratch& scratch) const;
    [[nodiscard]] std::uint32_t background(const Walk& walk) const;

    const Tracer& tracer_;
    Highlights highlights_;
    std::vector<SurfaceLook> looks_;  ///< by modifier
    bool unsteady_ = false;           ///< all of the scene
};

/// A ray on its way.
struct SceneSights::Walk {
    const RaySegment* pixel = nullptr;  ///< the ray it began as
    Sight* sight = nullptr;             ///< that it ends in
    Sight* image = nullptr;             ///< of what the first surface that counts mirrors; null
                                        ///< from there on
    RaySegment segment;                 ///< the way on
    bool slopes = true;                 ///< are asked for
    int surfaces = 0;                   ///< met, before that one or after
    double length = 0;                  ///< of the way so far [m]
    std::uint32_t met = 0;              ///< see Sight::surface

    /// Goes on from a hit, straight or mirrored.
    void pass(const Hit& hit, bool reflect);
};

class SceneSights::Scratch {
    friend class SceneSights;
    std::vector<Walk> ahead, images;  ///< on their ways
    std::vector<RaySegment> segments;
    std::vector<Hit> hits;
};

}  // namespace lightwalk
