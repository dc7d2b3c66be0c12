#pragma once
// What the surfaces of a model are to a ray, beside the numbers that were read for them: validated,
// packed, and nothing in it that a file could not keep.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/polygon.h"
#include "core/geometry/shapes.h"
#include "core/math/task_runner.h"
#include "core/model/column.h"
#include "core/model/surface_list.h"

namespace lightwalk {

/// Where a surface's shape is kept.
enum class ShapeKind : std::uint8_t { none, polygon, sphere, cone, ring, source };

/// What the search asks of a surface: of polygons, as most are, nearly all that there is.
struct ShapeRow {
    PolygonPlane plane;          ///< of a polygon; of others `first` is their place in a column
    std::int32_t modifier = -1;  ///< as in the surface's record
    PrimitiveType type{};        ///< validated: a sphere of negative radius is a bubble
    ShapeKind kind = ShapeKind::none;
    PolygonManner manner;

    /// Into the column of its kind; not of polygons.
    [[nodiscard]] std::uint32_t index() const { return plane.first; }
};
static_assert(sizeof(ShapeRow) == 48);

/// The shapes of a SurfaceList. Immutable.
class SurfaceShapes {
  public:
    struct Columns {
        Column<ShapeRow> rows;  ///< one a surface
        Column<SphereShape> spheres;
        Column<ConeShape> cones;
        Column<RingShape> rings;
        Column<SourceShape> sources;
        std::vector<std::string> warnings;  ///< of degenerate surfaces, in their order
    };

    SurfaceShapes() = default;
    explicit SurfaceShapes(Columns columns) : columns_(std::move(columns)) {}
    /// Takes what was stored. Throws InputError where it cannot be what make_shapes has made of
    /// this list, in so far as a search relies on it.
    SurfaceShapes(Columns columns, const SurfaceList& list);

    [[nodiscard]] std::size_t size() const { return columns_.rows.size(); }
    [[nodiscard]] const ShapeRow& row(std::size_t i) const { return columns_.rows[i]; }
    [[nodiscard]] const ConeShape& cone(std::size_t index) const { return columns_.cones[index]; }
    /// The shape of surface i; monostate for placements and degenerate (ignored) surfaces.
    /// @param list  the one that these shapes were made of
    [[nodiscard]] Shape shape(const SurfaceList& list, std::size_t i) const;
    /// Of a polygon.
    [[nodiscard]] PolygonShape polygon(const SurfaceList& list, std::size_t i) const;
    [[nodiscard]] bool is_finite(std::size_t i) const {
        const ShapeKind kind = row(i).kind;
        return kind != ShapeKind::none && kind != ShapeKind::source;
    }
    [[nodiscard]] const Columns& columns() const { return columns_; }
    /// In the process's own memory.
    [[nodiscard]] std::size_t own_bytes() const;
    /// In a file that is mapped.
    [[nodiscard]] std::size_t mapped_bytes() const;

  private:
    Columns columns_;
};

/// Validate all surfaces of a list. Throws InputError for the first bad one.
[[nodiscard]] SurfaceShapes make_shapes(const SurfaceList& list, const TaskRunner& task_runner);

}  // namespace lightwalk
