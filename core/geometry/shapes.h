#pragma once
// The exact shapes of Radiance's surfaces in double precision, validated from their real arguments.
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "core/geometry/point_list.h"
#include "core/math/vec3.h"
#include "core/model/surface_list.h"

namespace lightwalk {

/// Coordinates and radii beyond this could overflow in products of eight of them [m].
inline constexpr double kLargestCoordinate = 1e30;

// The structs below have no padding, whose bytes would be undefined: files that hold them are
// reproducible.

struct SphereShape {
    Vec3 center;
    double radius = 0;    ///< > 0 [m]
    bool inward = false;  ///< bubble: the normal points to the centre
    char unused[7] = {};
};

/// The outline of a polygon that is a rectangle along the two coordinates of the inside test; NaN
/// for other polygons.
struct OutlineRectangle {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double low_x = kNone, high_x = kNone, low_y = kNone, high_y = kNone;  ///< [m]
};

/// A polygon. Its vertices are a view of the arrays that they were read into.
struct PolygonShape {
    PointList vertices;  ///< closing duplicate dropped
    Vec3 normal;         ///< unit, right-hand rule
    double offset = 0;   ///< normal . p of the plane [m]
    int drop_axis = 2;   ///< coordinate that the inside test ignores
    OutlineRectangle rectangle;
};

/// Sum of the polygon's triangles around its first vertex: along the normal, twice its area [m²].
[[nodiscard]] Vec3 twice_area_of(const PointList& vertices);
[[nodiscard]] inline double area_of(const PolygonShape& polygon) {  ///< [m²]
    return length(twice_area_of(polygon.vertices)) / 2;
}

/// Cone, cup, cylinder, tube: an open surface of revolution with its smaller end first.
struct ConeShape {
    Vec3 p0, p1;            ///< ends; r0 <= r1
    double r0 = 0, r1 = 0;  ///< [m]
    Vec3 axis;              ///< unit, from p0 to p1
    double length = 0;      ///< [m]
    bool inward = false;    ///< cup, tube
    char unused[7] = {};
    double slope = 0;  ///< of the radius along the axis
};

struct RingShape {
    Vec3 center, normal;  ///< normal is unit
    double r0 = 0, r1 = 0;
};

/// A source at infinity: a cone of directions.
struct SourceShape {
    Vec3 direction;  ///< unit, towards the source
    float solid_angle =
        0;  ///< 2π(1 - cos(angle/2)), rounded up where the reference's float is [sr]
    float unused = 0;
};

using Shape =
    std::variant<std::monostate, SphereShape, PolygonShape, ConeShape, RingShape, SourceShape>;

/// One crossing of a ray with a shape.
struct ShapeHit {
    double t = 0;       ///< [m]
    Vec3 normal;        ///< unit, as the primitive defines it, not turned to the ray
    bool front = true;  ///< the sign that the tie rule of coincident surfaces uses
};

/// Validate the arguments of a finite surface or source. Degenerate input follows Radiance: `type`
/// may change (sphere <-> bubble, cone -> cylinder, ...), a useless surface becomes monostate; both
/// report by `warning` (left empty otherwise). Throws InputError for wrong argument counts or
/// numbers that are not finite or beyond kLargestCoordinate. The shape of a polygon refers to the
/// reals of the primitive.
struct ValidatedShape {
    Shape shape;
    PrimitiveType type{};
    std::string warning;
};
[[nodiscard]] ValidatedShape make_shape(const SurfacePrimitive& primitive);

/// Nearest crossing with t in (kEpsilon, t_max], or nothing. Exact: double precision, the inside
/// rules of Radiance (even-odd with tolerance for polygons, closed intervals for rings and cones).
[[nodiscard]] std::optional<ShapeHit> intersect(const Shape& shape, const Vec3& origin,
                                                const Vec3& direction, double t_max);

/// Nearest crossing with a cone, cup, cylinder or tube; as `intersect` of a Shape.
[[nodiscard]] std::optional<ShapeHit> intersect(const ConeShape& cone, const Vec3& origin,
                                                const Vec3& direction, double t_max);

/// Whether a direction lies inside a source at infinity: 2π(1 - s·v) <= Ω.
[[nodiscard]] inline bool contains(const SourceShape& source, const Vec3& direction) {
    return 2 * kPi * (1 - dot(source.direction, direction)) <=
           static_cast<double>(source.solid_angle);
}

}  // namespace lightwalk
