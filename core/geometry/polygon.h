#pragma once
// Points in polygons: Radiance's even-odd test, and an index that keeps it fast for outlines of
// many vertices.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/shapes.h"

namespace lightwalk {

/// Finds the edges that matter to the even-odd test of a point: the outline cut into slabs of its
/// second remaining coordinate. Gives the same answers as testing every edge. Holds at most 8
/// references an edge.
class EdgeIndex {
  public:
    explicit EdgeIndex(const PolygonShape& polygon);
    /// Edges that may matter for a point whose second remaining coordinate is `y`; edge i ends at
    /// vertex i.
    [[nodiscard]] std::pair<const std::uint32_t*, const std::uint32_t*> edges(double y) const;
    [[nodiscard]] std::size_t memory_bytes() const {
        return (first_.size() + edges_.size()) * sizeof(std::uint32_t);
    }

  private:
    [[nodiscard]] std::size_t slab(double y) const;

    double lowest_ = 0, slabs_per_meter_ = 0;
    std::vector<std::uint32_t> first_;  ///< of each slab, into edges_; one more at the end
    std::vector<std::uint32_t> edges_;
};

/// Outlines with more vertices than this are worth an EdgeIndex.
inline constexpr std::size_t kLargePolygon = 64;

/// The outline of a polygon whose normal and dropped axis are known.
[[nodiscard]] OutlineRectangle rectangle_of(const PolygonShape& polygon);

/// Whether a point of the polygon's plane lies inside its outline: even-odd rule, edges within
/// kEpsilon count as inside, so that the seam to a hole is solid. `index` may be null; else it must
/// be the polygon's own.
[[nodiscard]] bool contains(const PolygonShape& polygon, const Vec3& point, const EdgeIndex* index);

/// Crossing of a ray with a polygon, as `intersect` of its Shape.
[[nodiscard]] std::optional<ShapeHit> intersect(const PolygonShape& polygon, const Vec3& origin,
                                                const Vec3& direction, double t_max,
                                                const EdgeIndex* index);

/// Polygons as the search reads them: a cache line each; the corners lie apart, and rectangles
/// along the axes need theirs only near an edge. Same answers, to the bit, as `intersect` without
/// an index.
class PackedPolygons {
  public:
    /// Memory for so many polygons, and their vertices in all.
    void reserve(std::size_t polygons, std::size_t vertices) {
        planes_.reserve(polygons);
        ends_.reserve(polygons + 1);
        points_.reserve(vertices);
    }
    /// The handle by which the polygon is asked for.
    std::uint32_t add(const PolygonShape& polygon);
    [[nodiscard]] std::optional<ShapeHit> intersect(std::uint32_t handle, const Vec3& origin,
                                                    const Vec3& direction, double t_max) const;
    [[nodiscard]] std::size_t memory_bytes() const {
        return planes_.capacity() * (sizeof(Plane) + sizeof(std::uint32_t)) +
               points_.capacity() * sizeof(Point);
    }

  private:
    struct alignas(64) Plane {
        Vec3 normal;
        double offset = 0;
        OutlineRectangle rectangle;
    };
    struct Point {
        double x = 0, y = 0;  ///< the remaining coordinates, in cyclic order
    };
    [[nodiscard]] bool contains(std::uint32_t number, double x, double y) const;

    std::vector<Plane> planes_;
    std::vector<std::uint32_t> ends_{0};  ///< polygon i has the points from ends_[i] to ends_[i+1]
    std::vector<Point> points_;
};

}  // namespace lightwalk
