#include "core/geometry/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lightwalk {
namespace {

using Coordinate = double Vec3::*;

/// The two coordinates that remain when one is dropped, in cyclic order.
struct Axes {
    Coordinate x, y;
};

constexpr Axes kRemaining[3] = {{&Vec3::y, &Vec3::z}, {&Vec3::z, &Vec3::x}, {&Vec3::x, &Vec3::y}};

const Axes& remaining_axes(const PolygonShape& polygon) {
    return kRemaining[static_cast<std::size_t>(polygon.drop_axis)];
}

enum class EdgeTest { passes, crosses, touches };

/// Tests the edge a -> b: does it cross the positive x axis, or touch the origin (within the
/// tolerance)?
[[gnu::always_inline]] inline EdgeTest test_edge(double ax, double ay, double bx, double by) {
    const bool a_right = ax > 0, b_right = bx > 0;
    const bool spans = (ay > 0) != (by > 0);
    if (a_right == b_right) {
        if (!spans) return EdgeTest::passes;
        if (a_right) return EdgeTest::crosses;
        return std::abs(ax) <= kEpsilon && std::abs(bx) <= kEpsilon ? EdgeTest::touches
                                                                    : EdgeTest::passes;
    }
    if (std::abs(ay) <= kEpsilon && std::abs(by) <= kEpsilon) return EdgeTest::touches;
    if (!spans) return EdgeTest::passes;
    const double a = ay * bx, b = ax * by;
    if (std::abs(a - b) <= kEpsilon) return EdgeTest::touches;
    return (by > ay) != (a > b) ? EdgeTest::crosses : EdgeTest::passes;
}

/// Whether the origin lies within an outline; corner(i) gives x and y of its corners.
template <class Corner>
[[gnu::always_inline]] inline bool holds_origin(std::size_t count, const Corner& corner) {
    bool inside = false;
    auto [ax, ay] = corner(count - 1);
    for (std::size_t i = 0; i < count; ++i) {
        const auto [bx, by] = corner(i);
        const EdgeTest result = test_edge(ax, ay, bx, by);
        if (result == EdgeTest::touches) return true;
        if (result == EdgeTest::crosses) inside = !inside;
        ax = bx;
        ay = by;
    }
    return inside;
}

/// The signed distance of a point inside the sides of a rectangle. Beyond the tolerance of edges it
/// decides like the even-odd test.
[[gnu::always_inline]] inline double depth_in(const OutlineRectangle& r, double x, double y) {
    return std::min(std::min(x - r.low_x, r.high_x - x), std::min(y - r.low_y, r.high_y - y));
}

/// Whether a point is inside a rectangle: decided by its depth where that is clear, else by the
/// edges.
template <class Edges>
[[gnu::always_inline]] inline bool is_inside(double depth, const Edges& edges) {
    return std::abs(depth) > kEpsilon ? depth > 0 : edges();
}

template <Coordinate X, Coordinate Y>
bool contains_by_all_edges(const PolygonShape& polygon, const Vec3& point) {
    const double x = point.*X, y = point.*Y;
    return is_inside(depth_in(polygon.rectangle, x, y), [&] {
        return holds_origin(polygon.vertices.size(), [&](std::size_t i) {
            const Vec3 corner = polygon.vertices[i];
            return std::pair(corner.*X - x, corner.*Y - y);
        });
    });
}

bool contains_by_index(const PolygonShape& polygon, const Vec3& point, const EdgeIndex& index) {
    const auto [x, y] = remaining_axes(polygon);
    const auto [first, last] = index.edges(point.*y);
    const PointList& vertices = polygon.vertices;
    bool inside = false;
    for (const std::uint32_t* edge = first; edge != last; ++edge) {
        const Vec3 a = vertices[*edge == 0 ? vertices.size() - 1 : *edge - 1];
        const Vec3 b = vertices[*edge];
        const EdgeTest result =
            test_edge(a.*x - point.*x, a.*y - point.*y, b.*x - point.*x, b.*y - point.*y);
        if (result == EdgeTest::touches) return true;
        if (result == EdgeTest::crosses) inside = !inside;
    }
    return inside;
}

}  // namespace

OutlineRectangle rectangle_of(const PolygonShape& polygon) {
    const auto [x, y] = remaining_axes(polygon);
    if (polygon.vertices.size() != 4) return {};
    const PointList& points = polygon.vertices;
    const std::array<Vec3, 4> v{points[0], points[1], points[2], points[3]};
    const Coordinate first = v[0].*y == v[1].*y ? x : y, second = first == x ? y : x;
    const bool straight = v[0].*second == v[1].*second && v[1].*first == v[2].*first &&
                          v[2].*second == v[3].*second && v[3].*first == v[0].*first;
    if (!straight) return {};
    return {std::min(v[0].*x, v[2].*x), std::max(v[0].*x, v[2].*x), std::min(v[0].*y, v[2].*y),
            std::max(v[0].*y, v[2].*y)};
}

EdgeIndex::EdgeIndex(const PolygonShape& polygon) {
    const Coordinate y = remaining_axes(polygon).y;
    const PointList& vertices = polygon.vertices;
    lowest_ = vertices[0].*y;
    double highest = lowest_;
    for (const Vec3 vertex : vertices) {
        lowest_ = std::min(lowest_, vertex.*y);
        highest = std::max(highest, vertex.*y);
    }
    const double height = highest - lowest_;
    const auto range =
        [&](std::size_t edge) {  // slabs that the edge reaches, grown by the tolerance
            const double a = vertices[edge == 0 ? vertices.size() - 1 : edge - 1].*y,
                         b = vertices[edge].*y;
            return std::pair(slab(std::min(a, b) - 2 * kEpsilon),
                             slab(std::max(a, b) + 2 * kEpsilon));
        };

    const std::size_t budget = 8 * vertices.size();
    std::size_t references = 0;
    for (std::size_t slabs = std::max<std::size_t>(vertices.size() / 4, 1);; slabs /= 2) {
        slabs_per_meter_ = height > 0 ? static_cast<double>(slabs) / height : 0;
        if (!std::isfinite(slabs_per_meter_)) slabs_per_meter_ = 0;
        first_.assign(slabs + 1, 0);
        references = 0;
        for (std::size_t edge = 0; edge < vertices.size(); ++edge) {
            const auto [begin, end] = range(edge);
            references += end - begin + 1;
        }
        if (references <= budget || slabs == 1) break;
    }

    edges_.resize(references);
    for (std::size_t edge = 0; edge < vertices.size(); ++edge) {
        const auto [begin, end] = range(edge);
        for (std::size_t s = begin; s <= end; ++s) ++first_[s + 1];
    }
    for (std::size_t s = 1; s < first_.size(); ++s) first_[s] += first_[s - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t edge = 0; edge < vertices.size(); ++edge) {
        const auto [begin, end] = range(edge);
        for (std::size_t s = begin; s <= end; ++s)
            edges_[next[s]++] = static_cast<std::uint32_t>(edge);
    }
}

std::size_t EdgeIndex::slab(double y) const {
    const double position = (y - lowest_) * slabs_per_meter_;
    const auto last = static_cast<double>(first_.size() - 2);
    return static_cast<std::size_t>(position > 0 ? std::min(position, last)
                                                 : 0.0);  // NaN: the first slab
}

std::pair<const std::uint32_t*, const std::uint32_t*> EdgeIndex::edges(double y) const {
    const std::size_t s = slab(y);
    return {edges_.data() + first_[s], edges_.data() + first_[s + 1]};
}

bool contains(const PolygonShape& polygon, const Vec3& point, const EdgeIndex* index) {
    if (index) return contains_by_index(polygon, point, *index);
    switch (polygon.drop_axis) {
        case 0:
            return contains_by_all_edges<&Vec3::y, &Vec3::z>(polygon, point);
        case 1:
            return contains_by_all_edges<&Vec3::z, &Vec3::x>(polygon, point);
        default:
            return contains_by_all_edges<&Vec3::x, &Vec3::y>(polygon, point);
    }
}

std::optional<ShapeHit> intersect(const PolygonShape& polygon, const Vec3& origin,
                                  const Vec3& direction, double t_max, const EdgeIndex* index) {
    const double cosine = fused_dot(polygon.normal, direction);
    if (!(std::abs(cosine) > kEpsilon)) return std::nullopt;
    const double t = (polygon.offset - fused_dot(polygon.normal, origin)) / cosine;
    if (!(t > kEpsilon && t <= t_max)) return std::nullopt;
    if (!contains(polygon, origin + direction * t, index)) return std::nullopt;
    return ShapeHit{t, polygon.normal, cosine < 0};
}

std::optional<ShapeHit> intersect(const PolygonPlane& plane, PolygonManner manner,
                                  const CornerNumbers& numbers, const Vec3& origin,
                                  const Vec3& direction, double t_max) {
    const double cosine = fused_dot(plane.normal, direction);
    if (!(std::abs(cosine) > kEpsilon)) return std::nullopt;
    const double t = (plane.offset - fused_dot(plane.normal, origin)) / cosine;
    if (!(t > kEpsilon && t <= t_max)) return std::nullopt;
    const auto [x_axis, y_axis] = kRemaining[manner.drop_axis];
    const double x = origin.*x_axis + direction.*x_axis * t,
                 y = origin.*y_axis + direction.*y_axis * t;
    const std::size_t x_at = manner.drop_axis == 2 ? 0 : manner.drop_axis + 1,
                      y_at = manner.drop_axis == 0 ? 2 : manner.drop_axis - 1;
    if (manner.outline == Outline::shared) {
        const std::uint32_t* const corners = numbers.corners + plane.first;
        const bool inside = holds_origin(3, [&](std::size_t i) {
            const double* const corner = numbers.reals + corners[i];
            return std::pair(corner[x_at] - x, corner[y_at] - y);
        });
        return inside ? std::optional(ShapeHit{t, plane.normal, cosine < 0}) : std::nullopt;
    }
    const double *const xs = numbers.reals + plane.first + x_at, *const ys = numbers.reals +
                                                                             plane.first + y_at;
    double depth = OutlineRectangle::kNone;
    if (manner.outline == Outline::rectangle)
        depth = depth_in({std::min(xs[0], xs[6]), std::max(xs[0], xs[6]), std::min(ys[0], ys[6]),
                          std::max(ys[0], ys[6])},
                         x, y);
    const bool inside = is_inside(depth, [&] {
        return holds_origin(plane.corners,
                            [&](std::size_t i) { return std::pair(xs[3 * i] - x, ys[3 * i] - y); });
    });
    if (!inside) return std::nullopt;
    return ShapeHit{t, plane.normal, cosine < 0};
}

}  // namespace lightwalk
