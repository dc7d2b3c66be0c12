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

/// A polygon in the form that the search uses. Its corners stay in the arrays that they were read
/// into; for rectangles along the axes two of them suffice.
struct PolygonPlane {
    Vec3 normal;  ///< see PolygonShape
    double offset = 0;
    std::uint32_t first = 0;    ///< SurfaceList::place() of its surface
    std::uint32_t corners = 0;  ///< number of corners
};

/// How the corners of a polygon are stored.
enum class Outline : std::uint8_t {
    own,        ///< side by side
    rectangle,  ///< side by side, four of a rectangle along the coordinates of the inside test
    shared,     ///< three indices of points shared with other triangles
};

/// How a PolygonPlane is tested; kept apart from it so that it fills a gap of ShapeRow.
struct PolygonManner {
    std::uint8_t drop_axis = 2;
    Outline outline = Outline::own;
};

/// The arrays that hold the corners of a model's polygons.
struct CornerNumbers {
    const double* reals = nullptr;
    const std::uint32_t* corners = nullptr;  ///< indices into `reals`
};

/// Crossing of a ray with a packed polygon of at most kLargePolygon corners: the same result, to
/// the bit, as `intersect` of its PolygonShape without an index.
/// @param numbers  of the polygon's model
[[nodiscard]] std::optional<ShapeHit> intersect(const PolygonPlane& plane, PolygonManner manner,
                                                const CornerNumbers& numbers, const Vec3& origin,
                                                const Vec3& direction, double t_max);

}  // namespace lightwalk
