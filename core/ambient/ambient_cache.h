#pragma once
// Where ambient values are kept: the interface that serial and concurrent caches share.
#include <array>
#include <cstdint>
#include <span>

#include "core/ambient/ambient_record.h"

namespace lightwalk {

/// Logarithmic mean of the stored values' brightness, which -aw weighs -av against. Values whose
/// brightness is at most kEpsilon do not count.
struct AmbientLogMean {
    std::uint64_t count = 0;
    double sum = 0;  ///< sum of the logarithms
};

/// A lease on a place where a value is being computed, so that no second thread computes it too.
struct AmbientClaim {
    std::uint64_t number = 0;  ///< 0: none
    bool waited = false;       ///< another thread's value was waited for, and may serve: look again
};

class AmbientCache {
  public:
    AmbientCache() = default;
    virtual ~AmbientCache() = default;
    AmbientCache(const AmbientCache&) = delete;
    AmbientCache& operator=(const AmbientCache&) = delete;

    [[nodiscard]] virtual const AmbientLimits& limits() const = 0;
    /// Weighted sum of the records that serve a point; its weight is at most kEpsilon where none
    /// does.
    /// @param leaks  called for records that lie behind something near
    [[nodiscard]] virtual AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const = 0;
    virtual void insert(const AmbientRecord& record) = 0;

    // A cache that keeps, beside each value, what every light group adds to it:

    /// The same sum; to `groups`, one a group, the same sums of what the group adds are added.
    [[nodiscard]] virtual AmbientSum lookup_groups(
        const AmbientQuery& query, LeakTest leaks,
        std::span<std::array<double, 3>> /*groups*/) const {
        return lookup(query, leaks);
    }
    /// @param groups  add up to the record's value
    virtual void insert_with_groups(const AmbientRecord& record, std::span<const Rgb> /*groups*/) {
        insert(record);
    }

    /// Whether insert() keeps records; else the cache stays as it is.
    [[nodiscard]] virtual bool takes_values() const { return true; }
    [[nodiscard]] virtual AmbientLogMean log_mean() const = 0;

    /// Before a value is computed because a lookup found nothing: tells others, and may wait for a
    /// value that somebody computes close by. Every claim is to be released.
    [[nodiscard]] virtual AmbientClaim claim(const AmbientQuery&) { return {}; }
    virtual void release(const AmbientClaim&) {}
};

/// Limits of a scene's cube under -aa and -ar.
[[nodiscard]] AmbientLimits ambient_limits(const Vec3& origin, double size, double accuracy,
                                           int resolution);

/// A node's cube in the octree of records; each step down halves its edge.
struct CachePath {
    Vec3 corner;
    double edge = 0;
};
/// Go down to the child of the cube that holds `p`; returns the child's number.
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
