#pragma once
// Axis-aligned bounds of shapes and of placed models.
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/geometry/shapes.h"

namespace lightwalk {

/// Smallest box around the surface (a polygon: around its vertices). Empty for sources at infinity
/// and for no shape.
[[nodiscard]] Bounds bounds_of(const Shape& shape);
[[nodiscard]] Bounds bounds_of(const PolygonShape& polygon);

/// Box of every point at which `intersect` can report a hit: wider than bounds_of by the tolerances
/// of the inside rules, and by what a non-planar polygon's vertices lie off its mean plane.
[[nodiscard]] Bounds hit_bounds(const Shape& shape);
[[nodiscard]] Bounds hit_bounds(const PolygonShape& polygon);

/// The box, grown by `margin` on every side [m]; an empty one stays empty.
[[nodiscard]] Bounds grown(Bounds bounds, double margin);

/// Half of the surface area of a box, to which the number of rays that meet it is proportional
/// (surface area heuristic) [m²].
[[nodiscard]] double half_area(const Bounds& bounds);
/// Box around the transformed box.
[[nodiscard]] Bounds transformed(const Bounds& bounds, const Matrix& matrix);

/// The cube around a box as Radiance's octrees have it: same centre, 1e-5 more on each side [m].
[[nodiscard]] Bounds cube_around(const Bounds& bounds);

void extend(Bounds& bounds, const Bounds& other);

/// At most 64 boxes that together enclose the given ones, which are grouped by the cell of a grid
/// that their centre lies in. They enclose round or slanted things more tightly than one box would.
[[nodiscard]] std::vector<Bounds> outline_of(std::span<const Bounds> boxes);

[[nodiscard]] bool contains(const Bounds& bounds, const Vec3& point);

/// Where a ray enters a box, 0 when it starts inside; nothing when it misses the box [m].
[[nodiscard]] std::optional<double> entry(const Bounds& bounds, const Vec3& origin,
                                          const Vec3& direction);

/// Largest magnitude of a coordinate; 0 for an empty box [m].
[[nodiscard]] double magnitude(const Bounds& bounds);

}  // namespace lightwalk
