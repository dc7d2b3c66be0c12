#pragma once
// What a ray sees of a scene, without shading it: surfaces, panes and mirrors on its way.
#include <vector>

#include "core/cloud/highlights.h"
#include "core/cloud/primary_visibility.h"
#include "core/transport/tracer.h"

namespace lightwalk {

/// What one modifier's surfaces appearance like.
struct SurfaceAppearance {
    Appearance appearance = Appearance::unknown;
    float gloss = 0, roughness = 0, diffuse = 0;  ///< see MaterialTraits
    bool textured = false;                        ///< normals are turned
    bool patterned = false;
};

/// Follows the light of a pixel back to where it comes from: straight through panes and surfaces
/// without material, along the reflection of flat mirrors. Whether the first surface mirrors
/// something is told beside what lies ahead. Immutable; many threads may ask.
///
/// Surfaces whose appearance nobody can tell are reused as long as the eye does not move: bent or
/// curved mirrors, materials given by functions, refraction. In scenes with antimatter or a medium
/// nothing is reused.
class VisibilityProbe {
  public:
    /// The tracer must outlive this.
    explicit VisibilityProbe(const Tracer& tracer);

    /// Memory of searches, for the next ones. Each thread has its own.
    class Scratch;

    /// @param rays    the pixels'
    /// @param first   what each meets
    /// @param slopes  tell how steadily colours hold; else the slopes are only right where they are
    ///                kNeverReuse, which is cheaper
    /// @param visibility  of each ray; all but x and y are set, where `ray` says that there is one
    void find(std::span<const RaySegment> rays, std::span<const Hit> first, bool slopes,
              std::span<PixelVisibility> visibility, Scratch& scratch) const;

  private:
    struct Walk;
    [[nodiscard]] SurfaceAppearance appearance_of(ModifierId modifier) const;
    [[nodiscard]] SurfaceAppearance appearance_at(const Hit& hit) const;
    [[nodiscard]] bool reflects_flat(const Hit& hit, const SurfaceAppearance& appearance) const;
    void end(const Walk& walk, const Hit& hit, const SurfaceAppearance& appearance) const;
    [[nodiscard]] float glossy_slope(const Walk& walk, const Hit& hit,
                                     const SurfaceAppearance& appearance) const;
    [[nodiscard]] bool goes_on(Walk& walk, const Hit& hit) const;
    [[nodiscard]] bool begins(Walk& walk, const Hit& hit, std::vector<Walk>& images) const;
    void follow(std::vector<Walk>& walks, Scratch& scratch) const;
    [[nodiscard]] std::uint32_t background(const Walk& walk) const;

    const Tracer& tracer_;
    Highlights highlights_;
    std::vector<SurfaceAppearance> appearances_;  ///< by modifier
    bool never_reuse_ = false;                    ///< all of the scene
};

/// A ray on its way.
struct VisibilityProbe::Walk {
    const RaySegment* pixel = nullptr;        ///< the ray it began as
    PrimaryVisibility* seen_thing = nullptr;  ///< that it ends in
    PrimaryVisibility* image = nullptr;  ///< of what the first surface that counts mirrors; null
                                         ///< from there on
    RaySegment segment;                  ///< the way on
    bool slopes = true;                  ///< are asked for
    int surfaces = 0;                    ///< met, before that one or after
    double length = 0;                   ///< of the way so far [m]
    std::uint32_t met = 0;               ///< see PrimaryVisibility::surface

    /// Goes on from a hit, straight or mirrored.
    void pass(const Hit& hit, bool reflect);
};

class VisibilityProbe::Scratch {
    friend class VisibilityProbe;
    std::vector<Walk> ahead, images;  ///< on their ways
    std::vector<RaySegment> segments;
    std::vector<Hit> hits;
};

}  // namespace lightwalk
