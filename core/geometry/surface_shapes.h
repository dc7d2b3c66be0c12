#pragma once
// The validated shapes of a model's surfaces, packed into columns (structure of arrays) that can be
// stored in a file and mapped.
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

/// What the search needs of a surface: of polygons, which most surfaces are, nearly everything.
struct ShapeRow {
    PolygonPlane plane;  ///< of a polygon; of other shapes `first` is their index in a column
    std::int32_t modifier = -1;  ///< as in the surface's record
    PrimitiveType type{};        ///< validated: a sphere of negative radius is a bubble
    ShapeKind kind = ShapeKind::none;
    PolygonManner manner;

    /// Index into the column of its kind; not for polygons.
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
    /// Takes columns that were read from a file. Throws InputError where they violate what the
    /// search relies on, and so cannot be the result of make_shapes for this list.
    SurfaceShapes(Columns columns, const SurfaceList& list);

    [[nodiscard]] std::size_t size() const { return columns_.rows.size(); }
    [[nodiscard]] const ShapeRow& row(std::size_t i) const { return columns_.rows[i]; }
    [[nodiscard]] const ConeShape& cone(std::size_t index) const { return columns_.cones[index]; }
    /// The shape of surface i; monostate for placements and degenerate (ignored) surfaces.
    /// @param list  the list that these shapes were made of
    [[nodiscard]] Shape shape(const SurfaceList& list, std::size_t i) const;
    /// The shape of surface i, which must be a polygon.
    [[nodiscard]] PolygonShape polygon(const SurfaceList& list, std::size_t i) const;
    [[nodiscard]] bool is_finite(std::size_t i) const {
        const ShapeKind kind = row(i).kind;
        return kind != ShapeKind::none && kind != ShapeKind::source;
    }
    [[nodiscard]] const Columns& columns() const { return columns_; }
    /// Bytes in the process's own memory.
    [[nodiscard]] std::size_t own_bytes() const;
    /// Bytes in a mapped file.
    [[nodiscard]] std::size_t mapped_bytes() const;

  private:
    Columns columns_;
};

/// Validate all surfaces of a list. Throws InputError for the first bad one.
[[nodiscard]] SurfaceShapes make_shapes(const SurfaceList& list, const TaskRunner& task_runner);

}  // namespace lightwalk
