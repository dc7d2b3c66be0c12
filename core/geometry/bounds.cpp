#include "core/geometry/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightwalk {
namespace {

/// Inlined by force: called millions of times for a large model.
[[gnu::always_inline]] inline void include(Bounds& bounds, const Vec3& p) {
    bounds.lower = {std::min(bounds.lower.x, p.x), std::min(bounds.lower.y, p.y),
                    std::min(bounds.lower.z, p.z)};
    bounds.upper = {std::max(bounds.upper.x, p.x), std::max(bounds.upper.y, p.y),
                    std::max(bounds.upper.z, p.z)};
}

/// Extends the box by a disc: along each axis it reaches radius * sin(angle between axis and
/// normal).
void extend_by_disc(Bounds& bounds, const Vec3& center, const Vec3& normal, double radius) {
    Vec3 reach;
    for (std::size_t k = 0; k < 3; ++k) {
        reach[k] = radius * std::sqrt(std::max(0.0, 1 - normal[k] * normal[k]));
    }
    bounds.extend(center - reach);
    bounds.extend(center + reach);
}

/// How far hits may lie outside a polygon's edges along the axes of the inside test. A point counts
/// as on an edge where the triangle of both has less than kEpsilon / 2 of area, and lies in the
/// edge's own rectangle: the shorter the edge, the farther off it, but no farther than it is long.
class ReachOffEdges {
  public:
    /// @param length  of an edge, at least [m]
    [[gnu::always_inline]] void add(double length) {
        if (length > kFarthest)
            shortest_ = std::min(shortest_, length);
        else
            longest_ = std::max(longest_, length);
    }
    /// Over all edges the largest min(kEpsilon / length, length), which rises up to kFarthest and
    /// falls from there on: two of the edges tell it, with a single division. [m]
    [[nodiscard]] double largest() const { return std::max(longest_, kEpsilon / shortest_); }

  private:
    static constexpr double kFarthest = 1e-3;                    ///< root of kEpsilon
    double longest_ = 0;                                         ///< of those up to kFarthest
    double shortest_ = std::numeric_limits<double>::infinity();  ///< of the others
};

/// hit_bounds of a polygon whose inside test ignores axis Z: known while compiling, as this is
/// called millions of times for a large model.
template <std::size_t Z>
Bounds hit_bounds_along(const PolygonShape& polygon) {
    constexpr std::size_t kX = (Z + 1) % 3, kY = (Z + 2) % 3;
    const Vec3 normal = polygon.normal;
    Bounds bounds;
    double lowest = kHuge, highest = -kHuge;
    ReachOffEdges off;
    Vec3 from = polygon.vertices.back();
    for (const Vec3 to : polygon.vertices) {
        include(bounds, to);
        // Hits lie on the mean plane: drop each vertex onto it along Z.
        const double dropped = to[Z] + (polygon.offset - dot(normal, to)) / normal[Z];
        lowest = std::min(lowest, dropped);
        highest = std::max(highest, dropped);
        off.add(std::max(std::abs(to[kX] - from[kX]), std::abs(to[kY] - from[kY])));
        from = to;
    }
    // Off the edges the plane goes on along its slope, up or down.
    const double reach =
        off.largest() * (std::abs(normal[kX]) + std::abs(normal[kY])) / std::abs(normal[Z]);
    bounds.lower[Z] = std::min(bounds.lower[Z], lowest) - reach;
    bounds.upper[Z] = std::max(bounds.upper[Z], highest) + reach;
    return grown(bounds, 4 * kEpsilon);
}

}  // namespace

void Bounds::extend(const Vec3& p) {
    include(*this, p);
}

void extend(Bounds& bounds, const Bounds& other) {
    if (other.empty()) return;
    const Bounds before = bounds;
    for (std::size_t k = 0; k < 3; ++k) {
        bounds.lower[k] = std::min(before.lower[k], other.lower[k]);
        bounds.upper[k] = std::max(before.upper[k], other.upper[k]);
    }
}

Bounds bounds_of(const Shape& shape) {
    Bounds bounds;
    if (const auto* polygon = std::get_if<PolygonShape>(&shape)) {
        return bounds_of(*polygon);
    }
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
        const Vec3 reach{sphere->radius, sphere->radius, sphere->radius};
        bounds.extend(sphere->center - reach);
        bounds.extend(sphere->center + reach);
    } else if (const auto* cone = std::get_if<ConeShape>(&shape)) {
        extend_by_disc(bounds, cone->p0, cone->axis, cone->r0);
        extend_by_disc(bounds, cone->p1, cone->axis, cone->r1);
    } else if (const auto* ring = std::get_if<RingShape>(&shape)) {
        extend_by_disc(bounds, ring->center, ring->normal, ring->r1);
    }
    return bounds;
}

Bounds bounds_of(const PolygonShape& polygon) {
    Bounds bounds;
    for (const Vec3 vertex : polygon.vertices) include(bounds, vertex);
    return bounds;
}

Bounds hit_bounds(const Shape& shape) {
    if (const auto* polygon = std::get_if<PolygonShape>(&shape)) return hit_bounds(*polygon);
    return grown(bounds_of(shape), 4 * kEpsilon);
}

Bounds hit_bounds(const PolygonShape& polygon) {
    switch (polygon.drop_axis) {
        case 0:
            return hit_bounds_along<0>(polygon);
        case 1:
            return hit_bounds_along<1>(polygon);
        default:
            return hit_bounds_along<2>(polygon);
    }
}

Bounds grown(Bounds bounds, double margin) {
    if (bounds.empty()) return bounds;
    const Vec3 reach{margin, margin, margin};
    bounds.lower -= reach;
    bounds.upper += reach;
    return bounds;
}

std::vector<Bounds> outline_of(std::span<const Bounds> boxes) {
    constexpr std::size_t kCells = 4;  // along each axis
    Bounds all;
    for (const Bounds& box : boxes) extend(all, box);
    std::vector<Bounds> cells(kCells * kCells * kCells);
    const auto cell_of = [&](const Bounds& box) {
        std::size_t cell = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double size = all.upper[k] - all.lower[k],
                         from = (box.lower[k] + box.upper[k]) * 0.5 - all.lower[k];
            const double at = size > 0 ? kCells * from / size : 0;
            cell = cell * kCells + static_cast<std::size_t>(std::clamp(at, 0.0, kCells - 1.0));
        }
        return cell;
    };
    for (const Bounds& box : boxes)
        if (!box.empty()) extend(cells[cell_of(box)], box);
    std::erase_if(cells, [](const Bounds& box) { return box.empty(); });
    return cells;
}

double half_area(const Bounds& bounds) {
    if (bounds.empty()) return 0;
    const Vec3 size = bounds.upper - bounds.lower;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

Bounds transformed(const Bounds& bounds, const Matrix& matrix) {
    Bounds result;
    if (bounds.empty()) return result;
    for (unsigned corner = 0; corner < 8; ++corner) {
        result.extend(matrix.point({(corner & 1U) != 0 ? bounds.upper.x : bounds.lower.x,
                                    (corner & 2U) != 0 ? bounds.upper.y : bounds.lower.y,
                                    (corner & 4U) != 0 ? bounds.upper.z : bounds.lower.z}));
    }
    return result;
}

Bounds cube_around(const Bounds& bounds) {
    constexpr double kMargin = 1e-5;  // [m]
    if (bounds.empty()) return bounds;
    const Vec3 size = bounds.upper - bounds.lower, center = (bounds.lower + bounds.upper) * 0.5;
    const double half = std::max({size.x, size.y, size.z}) / 2 + kMargin;
    return {center - Vec3{half, half, half}, center + Vec3{half, half, half}};
}

bool contains(const Bounds& bounds, const Vec3& p) {
    return p.x >= bounds.lower.x && p.x <= bounds.upper.x && p.y >= bounds.lower.y &&
           p.y <= bounds.upper.y && p.z >= bounds.lower.z && p.z <= bounds.upper.z;
}

std::optional<double> entry(const Bounds& bounds, const Vec3& origin, const Vec3& direction) {
    double first = 0, last = kHuge;
    for (std::size_t k = 0; k < 3; ++k) {
        if (direction[k] == 0) {
            if (!(origin[k] >= bounds.lower[k] && origin[k] <= bounds.upper[k]))
                return std::nullopt;
            continue;
        }
        const double a = (bounds.lower[k] - origin[k]) / direction[k];
        const double b = (bounds.upper[k] - origin[k]) / direction[k];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    if (!(first <= last)) return std::nullopt;
    return first;
}

double magnitude(const Bounds& bounds) {
    if (bounds.empty()) return 0;
    return std::max({std::abs(bounds.lower.x), std::abs(bounds.lower.y), std::abs(bounds.lower.z),
                     std::abs(bounds.upper.x), std::abs(bounds.upper.y), std::abs(bounds.upper.z)});
}

}  // namespace lightwalk
