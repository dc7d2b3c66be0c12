#pragma once
// Finds what a ray sees of a scene without shading: the surfaces, panes and mirrors on its way.
#include <vector>

#include "core/cloud/data_cells.h"
#include "core/cloud/highlights.h"
#include "core/cloud/primary_visibility.h"
#include "core/trace/tracer.h"

namespace lightwalk {

/// The appearance of surfaces of one modifier.
struct SurfaceAppearance {
    Appearance appearance = Appearance::unknown;
    float gloss = 0, roughness = 0, diffuse = 0;  ///< see MaterialTraits
    bool textured = false;                        ///< normals are perturbed
    bool patterned = false;
};

/// Follows a pixel's ray to what it shows: straight through panes and surfaces without material,
/// and reflected by flat mirrors. The reflection of the first surface is found beside what lies
/// ahead. Immutable; many threads may use it at once.
///
/// Surfaces whose change of appearance cannot be predicted (curved or textured mirrors, materials
/// given by functions, refraction) get the slope kMirrorLike: they are reused only while the eye
/// does not move. In scenes with antimatter or a medium all slopes are kNeverReuse.
class VisibilityProbe {
  public:
    /// The tracer must outlive this.
    explicit VisibilityProbe(const Tracer& tracer);

    /// Reusable working memory; each thread needs its own.
    class Scratch;

    /// What a caller wants to know that takes time.
    struct Needs {
        bool slopes = false;  ///< else slopes are right only where they are kNeverReuse
        TraceContext* patterns = nullptr;  ///< what patterns are evaluated with; null: not needed
        /// Points will be shown for a moment: panes and mirrors with ripples show what even ones
        /// would, within their small bends.
        bool steered = false;
    };

    /// @param rays    of the pixels
    /// @param first   the nearest hit of each ray
    /// @param needs   beside places and surfaces
    /// @param visibility  in and out, for each ray with `ray` true: all members but x and y are set
    void find(std::span<const RaySegment> rays, std::span<const Hit> first, const Needs& needs,
              std::span<PixelVisibility> visibility, Scratch& scratch) const;

  private:
    struct Walk;
    [[nodiscard]] SurfaceAppearance appearance_of(ModifierId modifier) const;
    [[nodiscard]] SurfaceAppearance appearance_at(const Hit& hit) const;
    [[nodiscard]] bool reflects_flat(const Walk& walk, const Hit& hit,
                                     const SurfaceAppearance& appearance) const;
    [[nodiscard]] float ripple_slope(const Walk& walk, const Hit& hit,
                                     const SurfaceAppearance& appearance) const;
    void end(const Walk& walk, const Hit& hit, const SurfaceAppearance& appearance) const;
    [[nodiscard]] float glossy_slope(const Walk& walk, const Hit& hit,
                                     const SurfaceAppearance& appearance) const;
    [[nodiscard]] Ray modified_ray(const Walk& walk, const Hit& hit,
                                   bool (*applies)(PrimitiveKind)) const;
    [[nodiscard]] float pattern_at(const Walk& walk, const Hit& hit) const;
    [[nodiscard]] bool goes_on(Walk& walk, const Hit& hit) const;
    [[nodiscard]] bool begins(Walk& walk, const Hit& hit, std::vector<Walk>& images) const;
    void follow(std::vector<Walk>& walks, Scratch& scratch) const;
    [[nodiscard]] std::uint32_t met(const Walk& walk, const Hit& hit) const;
    [[nodiscard]] std::uint32_t background(const Walk& walk) const;

    const Tracer& tracer_;
    Highlights highlights_;
    DataCells data_cells_;
    std::vector<SurfaceAppearance> appearances_;  ///< by modifier
    bool never_reuse_ = false;                    ///< for all surfaces of the scene
};

/// The state of a ray that is followed.
struct VisibilityProbe::Walk {
    const RaySegment* pixel = nullptr;     ///< the pixel's ray
    PrimaryVisibility* primary = nullptr;  ///< result, set at the end
    PrimaryVisibility* image =
        nullptr;  ///< result for the reflection of the first surface with a material; null after it
    RaySegment segment;  ///< the remaining ray
    Needs needs;
    int surfaces = 0;       ///< number of surfaces met, before or after the first with a material
    double length = 0;      ///< of the path so far [m]
    std::uint32_t met = 0;  ///< see PrimaryVisibility::surface

    /// Continue from a hit, straight on or reflected.
    void pass(const Hit& hit, bool reflect);
};

class VisibilityProbe::Scratch {
    friend class VisibilityProbe;
    std::vector<Walk> ahead, images;  ///< rays being followed
    std::vector<RaySegment> segments;
    std::vector<Hit> hits;
};

}  // namespace lightwalk
