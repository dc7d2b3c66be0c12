#pragma once
// Where a mirror or prism sends light: most points of a room lie outside, and need no sample of the
// virtual source to learn it.
#include <array>

#include "core/math/plane.h"

namespace lightwalk {

/// The set of all lines from a virtual source's sampling box through the outline of its mirror or
/// prism, beyond that surface: a pyramid whose sides touch the outline and the far corners of the
/// box.
struct VirtualSourceBeam {
    Plane surface;               ///< the source is above
    std::array<Plane, 4> sides;  ///< the beam is above

    /// Whether a ray from the point to a sample of the source may meet the redirecting surface. May
    /// be true though none does.
    [[nodiscard]] bool may_reach(const Vec3& point) const {
        if (surface.height(point) >= 0) return true;  // on the source's side: not for us to say
        for (const Plane& side : sides) {
            if (side.height(point) < -kEpsilon) return false;
        }
        return true;
    }
};

}  // namespace lightwalk
