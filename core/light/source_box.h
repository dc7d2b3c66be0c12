#pragma once
// The box in which a light source is sampled.
#include "core/math/vec3.h"
#include "core/model/primitive_type.h"

namespace lightwalk {

// Half widths of the sampling boxes of round sources over their radius. Radiance's constants, as
// its values show them.
inline constexpr double kSphereBox = 0.7236;
inline constexpr double kCylinderBox = 0.8559;  ///< across the axis

/// A parallelepiped about the source, or a parallelogram in the plane of a flat source. Boxes of
/// distant sources (type source) hold directions in place of points.
struct SourceBox {
    PrimitiveType shape = PrimitiveType::sphere;  ///< of the real source
    Vec3 center;                                  ///< unit direction of a distant source
    Vec3 u, v, w;                                 ///< half axes; a cylinder's axis is u
    Vec3 normal;                                  ///< of a flat source's front
    float radius = 0;                             ///< of a sphere around the source, about [m]
    float size = 0;  ///< projected area [m²]; solid angle of a distant source [sr]

    [[nodiscard]] bool is_distant() const { return shape == PrimitiveType::source; }
    [[nodiscard]] bool is_cylinder() const { return shape == PrimitiveType::cylinder; }
    /// Only its front sends light.
    [[nodiscard]] bool is_flat() const {
        return shape == PrimitiveType::polygon || shape == PrimitiveType::ring;
    }
    /// Its outline is a circle: samples are squeezed from the box into it.
    [[nodiscard]] bool is_round() const {
        return shape == PrimitiveType::sphere || shape == PrimitiveType::ring || is_distant();
    }
};

}  // namespace lightwalk
