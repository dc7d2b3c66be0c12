#pragma once
// What the light source list asks of a material that sends light on in a new direction (prism1,
// prism2).
#include <optional>

#include "core/math/vec3.h"

namespace lightwalk {

struct Ray;
struct TraceContext;

/// One projection of a redirecting surface, evaluated where a ray met it.
struct Redirection {
    double coefficient = 0;  ///< share of the radiance that goes this way
    Vec3 direction;          ///< world space, as the expressions give it: not normalised
};

/// A material that redirects light by expressions: the list of light sources makes virtual sources
/// from them. The prisms implement it beside Modifier (found by dynamic_cast); mirrors need no
/// evaluation.
class RedirectingModifier {
  public:
    virtual ~RedirectingModifier() = default;

    /// How many projections there are (prism1: 1, prism2: 2).
    [[nodiscard]] virtual int branches() const = 0;

    /// Evaluate one projection for a ray that hit the surface, without a source to aim at (DxA, DyA
    /// and DzA are 0). The transform of the material applies; redirecting surfaces are never inside
    /// an instance. Nothing when an expression failed.
    [[nodiscard]] virtual std::optional<Redirection> redirect(int branch, const Ray& hit_ray,
                                                              TraceContext& context) const = 0;
};

}  // namespace lightwalk
