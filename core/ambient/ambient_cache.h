#pragma once
// Where ambient values are kept: the interface that serial and concurrent caches share.
#include <cstdint>

#include "core/ambient/ambient_record.h"

namespace lightwalk {

/// Of all values stored with a brightness above kEpsilon: what -aw weighs -av against.
struct AmbientLogMean {
    std::uint64_t count = 0;
    double sum = 0;  ///< of the logarithms of their brightness
};

/// A value that somebody computes.
struct AmbientClaim {
    std::uint64_t number = 0;  ///< 0: none
    bool waited = false;       ///< for another value, that may serve: look again
};

class AmbientCache {
  public:
    AmbientCache() = default;
    virtual ~AmbientCache() = default;
    AmbientCache(const AmbientCache&) = delete;
    AmbientCache& operator=(const AmbientCache&) = delete;

    [[nodiscard]] virtual const AmbientLimits& limits() const = 0;
    /// What the records around a point say; the weight is at most kEpsilon where none does. `leaks`
    /// is called for records behind something near.
    [[nodiscard]] virtual AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const = 0;
    virtual void insert(const AmbientRecord& record) = 0;
    [[nodiscard]] virtual AmbientLogMean log_mean() const = 0;

    /// Before a value is computed because a lookup found nothing: tells others, and may wait for a
    /// value that somebody computes close by. Every claim is to be released.
    [[nodiscard]] virtual AmbientClaim claim(const AmbientQuery&) { return {}; }
    virtual void release(const AmbientClaim&) {}
};

/// Limits of a scene's cube under -aa and -ar.
[[nodiscard]] AmbientLimits ambient_limits(const Vec3& origin, double size, double accuracy,
                                           int resolution);

/// The way of a record or a query down the tree: cubes of half the edge at each step.
struct CachePath {
    Vec3 corner;
    double edge = 0;
};
/// Child of the cube that holds `p`; halves the cube.
[[nodiscard]] inline unsigned descend(CachePath& cube, const std::array<float, 3>& p) {
    cube.edge *= 0.5;
    unsigned child = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (static_cast<double>(p[k]) <= cube.corner[k] + cube.edge) continue;
        cube.corner[k] += cube.edge;
        child |= 1U << k;
    }
    return child;
}
/// The child's cube.
[[nodiscard]] inline CachePath child_cube(const CachePath& cube, unsigned child) {
    CachePath result{cube.corner, cube.edge * 0.5};
    for (std::size_t k = 0; k < 3; ++k) {
        if ((child >> k & 1U) != 0) result.corner[k] += result.edge;
    }
    return result;
}
/// Whether records of the cube can reach a point: it lies within the cube grown by its edge.
[[nodiscard]] inline bool reaches(const CachePath& cube, const Vec3& p) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (p[k] < cube.corner[k] - cube.edge || p[k] > cube.corner[k] + 2 * cube.edge)
            return false;
    }
    return true;
}

}  // namespace lightwalk
