#pragma once
// Separate rays, as rtrace takes them.
#include <cstdint>

#include "core/math/vec3.h"

namespace lightwalk {

/// A ray to trace; a zero direction is answered like a ray that hits nothing.
struct RayQuery {
    Vec3 origin, direction;  ///< direction of any length
};

struct RayListOptions {
    bool shade = true;             ///< false: nearest hits only
    bool sensor = false;           ///< irradiance at the origin facing the direction (rtrace -I)
    bool limit_by_length = false;  ///< the direction's length limits the ray (rtrace -ld)
    std::uint64_t seed = 0;
};

}  // namespace lightwalk
