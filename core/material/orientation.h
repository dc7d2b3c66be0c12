#pragma once
// The direction along which an anisotropic surface is brushed, given by three expressions.
#include "core/material/lobes.h"
#include "core/texture/function_binding.h"

namespace lightwalk {

/// The tangent frame of a hit.
struct OrientedFrame {
    LobeFrame frame;
    bool isotropic = false;  ///< no direction was given, or one along the normal
};

/// The frame with normal n whose u is the projection of `along` to the surface; an arbitrary fixed
/// one, marked isotropic, when `along` is zero or runs along the normal.
[[nodiscard]] OrientedFrame orient(const Vec3& along, const Vec3& n);

/// The brushing direction of plastic2, metal2, trans2 and ashik2: their string arguments `ux uy uz
/// file transform`.
class Orientation {
  public:
    explicit Orientation(const ModifierBuild& build);
    /// The frame at the ray's hit. Warns where the expressions have no value.
    /// @param n  shading normal
    [[nodiscard]] OrientedFrame at(const Ray& ray, const Vec3& n, TraceContext& context) const;

  private:
    FunctionBinding binding_;
};

}  // namespace lightwalk
