#include "core/geometry/surface_shapes.h"

#include <array>
#include <cmath>
#include <exception>
#include <utility>
#include <variant>

namespace lightwalk {
namespace {

constexpr std::size_t kKinds = 6;

/// The kind of shape of a primitive type, before its arguments are validated.
ShapeKind kind_of_type(PrimitiveType type) {
    using enum PrimitiveType;
    switch (type) {
        case polygon:
            return ShapeKind::polygon;
        case sphere:
        case bubble:
            return ShapeKind::sphere;
        case cone:
        case cup:
        case cylinder:
        case tube:
            return ShapeKind::cone;
        case ring:
            return ShapeKind::ring;
        case source:
            return ShapeKind::source;
        default:
            return ShapeKind::none;
    }
}

using Counts = std::array<std::uint32_t, kKinds>;

std::uint32_t& count_of(Counts& counts, ShapeKind kind) {
    return counts[static_cast<std::size_t>(kind)];
}

/// Results for one part of the list, which is validated in parallel.
struct Part {
    Counts first{};  ///< index of its first shape in each column
    std::vector<std::string> warnings;
    std::exception_ptr error;
};

/// The columns while they are filled. Each surface has an element in the column of its kind, used
/// or not, so that parts of the list can be filled in parallel.
struct OpenColumns {
    std::span<ShapeRow> rows;
    std::span<SphereShape> spheres;
    std::span<ConeShape> cones;
    std::span<RingShape> rings;
    std::span<SourceShape> sources;

    static void put(const PolygonShape& polygon, const SurfaceList& list, std::size_t i,
                    ShapeRow& row) {
        row.plane = {polygon.normal, polygon.offset, list.place(i),
                     static_cast<std::uint32_t>(polygon.vertices.size())};
        const bool is_rectangle = !std::isnan(polygon.rectangle.low_x);
        row.manner = {static_cast<std::uint8_t>(polygon.drop_axis),
                      list.shares_corners(i) ? Outline::shared
                      : is_rectangle         ? Outline::rectangle
                                             : Outline::own};
    }
    void put(const Shape& shape, const SurfaceList& list, std::size_t i, ShapeRow& row) const {
        const std::uint32_t at = row.index();
        if (const auto* polygon = std::get_if<PolygonShape>(&shape))
            put(*polygon, list, i, row);
        else if (const auto* sphere = std::get_if<SphereShape>(&shape))
            spheres[at] = *sphere;
        else if (const auto* cone = std::get_if<ConeShape>(&shape))
            cones[at] = *cone;
        else if (const auto* ring = std::get_if<RingShape>(&shape))
            rings[at] = *ring;
        else if (const auto* source = std::get_if<SourceShape>(&shape))
            sources[at] = *source;
    }
};

void fill_part(const SurfaceList& list, std::size_t first, std::size_t last,
               const OpenColumns& columns, Part& part) {
    Counts next = part.first;
    for (std::size_t i = first; i < last; ++i) {
        const SurfacePrimitive surface = list[i];
        ShapeRow& row = columns.rows[i];
        row.type = surface.type;
        row.modifier = surface.modifier;
        const ShapeKind kind = kind_of_type(surface.type);
        if (kind == ShapeKind::none) continue;
        row.plane.first = count_of(next, kind)++;
        const ValidatedShape valid = make_shape(surface);
        if (!valid.warning.empty()) {
            part.warnings.push_back(to_prefix(surface.where()) +
                                    std::string(to_string(surface.type)) + " \"" +
                                    std::string(surface.name) + "\": " + valid.warning);
        }
        row.type = valid.type;
        if (std::holds_alternative<std::monostate>(valid.shape)) continue;
        row.kind = kind;
        columns.put(valid.shape, list, i, row);
    }
}

/// Counts the shapes before each part (prefix sum); returns the total.
Counts count_shapes(const SurfaceList& list, const TaskRunner& task_runner,
                    std::vector<Part>& parts) {
    for_each_part(task_runner, list.size(),
                  [&](std::size_t part, std::size_t first, std::size_t last) {
                      for (std::size_t i = first; i < last; ++i)
                          ++count_of(parts[part].first, kind_of_type(list.type(i)));
                  });
    Counts all{};
    for (Part& part : parts) {
        for (std::size_t k = 0; k < kKinds; ++k)
            part.first[k] = std::exchange(all[k], all[k] + part.first[k]);
    }
    return all;
}

[[noreturn]] void refuse_shapes(const char* what) {
    throw InputError(std::string("damaged shapes: ") + what);
}

bool is_usable(const Vec3& v) {
    return std::abs(v.x) <= kLargestCoordinate && std::abs(v.y) <= kLargestCoordinate &&
           std::abs(v.z) <= kLargestCoordinate;
}

/// Checks that the search stays within the corners of a polygon, and does not divide by zero.
void check_polygon(const ShapeRow& row, const SurfaceList& list, std::size_t i) {
    const PolygonPlane& plane = row.plane;
    if (row.manner.drop_axis > 2) refuse_shapes("an axis that is none");
    const Outline outline = row.manner.outline;
    if (plane.first != list.place(i) || plane.corners < 3 ||
        plane.corners > list.reals(i).size() / 3 || outline > Outline::shared ||
        (outline == Outline::rectangle && plane.corners != 4) ||
        (outline == Outline::shared) != list.shares_corners(i))
        refuse_shapes("a polygon with other corners");
    if (!is_usable(plane.normal) || !(std::abs(plane.offset) <= 4 * kLargestCoordinate) ||
        plane.normal[row.manner.drop_axis] == 0)
        refuse_shapes("a polygon without a plane");
}

std::size_t column_size(const SurfaceShapes::Columns& columns, ShapeKind kind) {
    switch (kind) {
        case ShapeKind::sphere:
            return columns.spheres.size();
        case ShapeKind::cone:
            return columns.cones.size();
        case ShapeKind::ring:
            return columns.rings.size();
        case ShapeKind::source:
            return columns.sources.size();
        default:
            return 0;
    }
}

}  // namespace

SurfaceShapes::SurfaceShapes(Columns columns, const SurfaceList& list)
    : columns_(std::move(columns)) {
    if (size() != list.size()) refuse_shapes("not one a surface");
    for (std::size_t i = 0; i < size(); ++i) {
        const ShapeRow& own = row(i);
        if (static_cast<std::size_t>(own.type) >= primitive_type_count() ||
            own.modifier != list.modifier(i) ||
            kind_of_type(own.type) != kind_of_type(list.type(i)))
            refuse_shapes("another type or modifier");
        if (own.kind == ShapeKind::none) continue;
        const bool is_polygon = own.kind == ShapeKind::polygon;
        if (own.kind != kind_of_type(own.type) ||
            (!is_polygon && own.index() >= column_size(columns_, own.kind)))
            refuse_shapes("a place that is none");
        if (!is_polygon) continue;
        check_polygon(own, list, i);
    }
    for (const double real : list.columns().reals)
        if (!std::isfinite(real)) refuse_shapes("a number that is none");
}

Shape SurfaceShapes::shape(const SurfaceList& list, std::size_t i) const {
    const ShapeRow& own = row(i);
    switch (own.kind) {
        case ShapeKind::polygon:
            return polygon(list, i);
        case ShapeKind::sphere:
            return columns_.spheres[own.index()];
        case ShapeKind::cone:
            return columns_.cones[own.index()];
        case ShapeKind::ring:
            return columns_.rings[own.index()];
        case ShapeKind::source:
            return columns_.sources[own.index()];
        default:
            return std::monostate{};
    }
}

PolygonShape SurfaceShapes::polygon(const SurfaceList& list, std::size_t i) const {
    const auto& [plane, modifier, type, kind, manner] = row(i);
    PolygonShape polygon;
    polygon.vertices = PointList(list.reals(i)).first(plane.corners);
    polygon.normal = plane.normal;
    polygon.offset = plane.offset;
    polygon.drop_axis = manner.drop_axis;
    if (manner.outline == Outline::rectangle) polygon.rectangle = rectangle_of(polygon);
    return polygon;
}

std::size_t SurfaceShapes::own_bytes() const {
    return columns_.rows.own_bytes() + columns_.spheres.own_bytes() + columns_.cones.own_bytes() +
           columns_.rings.own_bytes() + columns_.sources.own_bytes();
}

std::size_t SurfaceShapes::mapped_bytes() const {
    return columns_.rows.mapped_bytes() + columns_.spheres.mapped_bytes() +
           columns_.cones.mapped_bytes() + columns_.rings.mapped_bytes() +
           columns_.sources.mapped_bytes();
}

SurfaceShapes make_shapes(const SurfaceList& list, const TaskRunner& task_runner) {
    std::vector<Part> parts(part_count(list.size()));
    Counts counts = count_shapes(list, task_runner, parts);
    SurfaceShapes::Columns columns;
    const OpenColumns open{columns.rows.zeros(list.size()),
                           columns.spheres.zeros(count_of(counts, ShapeKind::sphere)),
                           columns.cones.zeros(count_of(counts, ShapeKind::cone)),
                           columns.rings.zeros(count_of(counts, ShapeKind::ring)),
                           columns.sources.zeros(count_of(counts, ShapeKind::source))};
    for_each_part(
        task_runner, list.size(), [&](std::size_t part, std::size_t first, std::size_t last) {
            try {
                fill_part(list, first, last, open, parts[part]);
            } catch (...) {
                parts[part].error = std::current_exception();  // of several errors the first in the
                                                               // list's order is reported
            }
        });
    for (Part& part : parts) {
        for (std::string& warning : part.warnings) columns.warnings.push_back(std::move(warning));
        if (part.error) std::rethrow_exception(part.error);
    }
    return SurfaceShapes(std::move(columns));
}

}  // namespace lightwalk
