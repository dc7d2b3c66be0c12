#pragma once
// Which way a brushed surface is brushed: tangents from three expressions.
#include "core/material/lobes.h"
#include "core/texture/function_binding.h"

namespace lightwalk {

/// The tangent frame of a hit. `isotropic`: the expressions gave no direction across the normal.
struct OrientedFrame {
    LobeFrame frame;
    bool isotropic = false;
};

/// The frame with normal n whose u is the projection of `along`; an arbitrary fixed one, marked
/// isotropic, when `along` has none.
[[nodiscard]] OrientedFrame orient(const Vec3& along, const Vec3& n);

/// Strings `ux uy uz file transform` of plastic2 and relatives.
class Orientation {
  public:
    explicit Orientation(const ModifierBuild& build);
    /// @param n  shading normal
    [[nodiscard]] OrientedFrame at(const Ray& ray, const Vec3& n, TraceContext& context) const;

  private:
    FunctionBinding binding_;
};

}  // namespace lightwalk
