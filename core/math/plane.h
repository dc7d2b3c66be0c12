#pragma once
// Planes.
#include "core/math/vec3.h"

namespace lightwalk {

struct Plane {
    Vec3 normal;        ///< unit
    double offset = 0;  ///< normal . x of its points [m]
    [[nodiscard]] double height(const Vec3& point) const { return dot(normal, point) - offset; }
};

}  // namespace lightwalk
