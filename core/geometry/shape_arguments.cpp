// Validation of shapes from the real arguments of scene primitives; degenerate input as in
// Radiance.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/geometry/polygon.h"
#include "core/geometry/shapes.h"

namespace lightwalk {
namespace {

[[noreturn]] void fail(const SurfacePrimitive& primitive, const std::string& problem) {
    throw InputError(primitive.where(), std::string(to_string(primitive.type)) + " \"" +
                                            std::string(primitive.name) + "\": " + problem);
}

void expect_count(const SurfacePrimitive& primitive, std::size_t count, const char* problem) {
    if (primitive.reals.size() == count) return;
    fail(primitive, std::string(problem) + ": expected " + std::to_string(count) +
                        " real arguments, found " + std::to_string(primitive.reals.size()));
}

void expect_finite(const SurfacePrimitive& primitive) {
    for (std::size_t i = 0; i < primitive.reals.size(); ++i) {
        if (std::abs(primitive.reals[i]) <= kLargestCoordinate) continue;  // false for NaN
        fail(primitive, "real argument " + std::to_string(i + 1) +
                            " is not a usable number: expected a magnitude of at most 1e30");
    }
}

Vec3 point_at(const RealArguments& reals, std::size_t i) {
    return {reals[i], reals[i + 1], reals[i + 2]};
}

double zero_if_tiny(double radius) {
    return std::abs(radius) <= kEpsilon ? 0 : radius;
}

/// sphere <-> bubble, cone <-> cup, cylinder <-> tube.
PrimitiveType other_side(PrimitiveType type) {
    switch (type) {
        case PrimitiveType::sphere:
            return PrimitiveType::bubble;
        case PrimitiveType::bubble:
            return PrimitiveType::sphere;
        case PrimitiveType::cone:
            return PrimitiveType::cup;
        case PrimitiveType::cup:
            return PrimitiveType::cone;
        case PrimitiveType::cylinder:
            return PrimitiveType::tube;
        default:
            return PrimitiveType::cylinder;
    }
}

bool faces_inward(PrimitiveType type) {
    return type == PrimitiveType::bubble || type == PrimitiveType::cup ||
           type == PrimitiveType::tube;
}

ValidatedShape ignored(PrimitiveType type, std::string warning) {
    return {std::monostate{}, type, std::move(warning) + ", ignored"};
}

ValidatedShape make_sphere(const SurfacePrimitive& primitive) {
    expect_count(primitive, 4, "bad arguments");
    expect_finite(primitive);
    ValidatedShape result{std::monostate{}, primitive.type, {}};
    const double radius = zero_if_tiny(primitive.reals[3]);
    if (radius == 0) return ignored(primitive.type, "zero radius");
    if (radius < 0) {
        result.type = other_side(primitive.type);
        result.warning = "negative radius";
    }
    result.shape =
        SphereShape{point_at(primitive.reals, 0), std::abs(radius), faces_inward(result.type)};
    return result;
}

/// Tolerance 1e-5, relative to the plane's distance from the origin where that is larger.
bool is_planar(const PointList& vertices, const Vec3& normal) {
    constexpr double kTolerance = 1e-5;
    if (vertices.size() <= 3) return true;
    double sum = dot(normal, vertices[0]);
    const bool near_origin = std::abs(sum) <= kTolerance;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const double mean = sum / static_cast<double>(i), offset = dot(normal, vertices[i]);
        if (std::abs(near_origin ? offset - mean : 1 - offset / mean) > kTolerance) return false;
        sum += offset;
    }
    return true;
}

bool coincide(const Vec3& a, const Vec3& b) {
    return std::abs(a.x - b.x) <= kEpsilon && std::abs(a.y - b.y) <= kEpsilon &&
           std::abs(a.z - b.z) <= kEpsilon;
}

/// The axis along which the normal is longest; of equals x goes before y, and y before z.
int longest_axis(const Vec3& normal) {
    const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    const int axis = x >= y ? 0 : 1;
    return z > (axis == 0 ? x : y) ? 2 : axis;
}

ValidatedShape make_polygon(const SurfacePrimitive& primitive) {
    const RealArguments& reals = primitive.reals;
    if (reals.size() < 9 || reals.size() % 3 != 0) {
        fail(primitive,
             "bad # arguments: expected three coordinates for each of at least three vertices, "
             "found " +
                 std::to_string(reals.size()) + " real arguments");
    }
    expect_finite(primitive);
    PolygonShape polygon;
    PointList& vertices = polygon.vertices;
    vertices = PointList(reals);
    if (vertices.size() > 3 && coincide(vertices.front(), vertices.back()))
        vertices = vertices.without_last();
    const Vec3 twice_area = twice_area_of(vertices);
    if (!(length(twice_area) / 2 > 0)) return ignored(primitive.type, "zero area");
    polygon.normal = normalize(twice_area);
    for (const Vec3 vertex : vertices) polygon.offset += dot(polygon.normal, vertex);
    polygon.offset /= static_cast<double>(vertices.size());
    polygon.drop_axis = longest_axis(polygon.normal);
    polygon.rectangle = rectangle_of(polygon);
    ValidatedShape result{std::monostate{}, primitive.type, {}};
    if (!is_planar(vertices, polygon.normal)) result.warning = "non-planar vertex";
    result.shape = polygon;
    return result;
}

/// Ends and radii of the cone family, before they are put in order.
struct ConeArguments {
    Vec3 p0, p1;
    double r0 = 0, r1 = 0;
};

ValidatedShape make_cone_shape(const ConeArguments& ends, ValidatedShape result) {
    ConeShape cone{ends.p0, ends.p1, ends.r0, ends.r1, {}, 0, faces_inward(result.type)};
    if (cone.r0 > cone.r1) {
        std::swap(cone.p0, cone.p1);
        std::swap(cone.r0, cone.r1);
    }
    cone.axis = normalize(cone.p1 - cone.p0);
    cone.length = length(cone.p1 - cone.p0);
    if (cone.axis == Vec3{}) return ignored(result.type, "unknown orientation");
    cone.slope = (cone.r1 - cone.r0) / cone.length;
    result.shape = cone;
    return result;
}

ValidatedShape make_cylinder(const SurfacePrimitive& primitive) {
    expect_count(primitive, 7, "bad # arguments");
    expect_finite(primitive);
    ValidatedShape result{std::monostate{}, primitive.type, {}};
    const double radius = zero_if_tiny(primitive.reals[6]);
    if (radius == 0) return ignored(primitive.type, "illegal radii");
    if (radius < 0) {
        result.type = other_side(primitive.type);
        result.warning = "negative radii";
    }
    const double size = std::abs(radius);
    return make_cone_shape({point_at(primitive.reals, 0), point_at(primitive.reals, 3), size, size},
                           std::move(result));
}

ValidatedShape make_cone(const SurfacePrimitive& primitive) {
    expect_count(primitive, 8, "bad # arguments");
    expect_finite(primitive);
    ValidatedShape result{std::monostate{}, primitive.type, {}};
    double r0 = zero_if_tiny(primitive.reals[6]), r1 = zero_if_tiny(primitive.reals[7]);
    if ((r0 == 0 && r1 == 0) || (r0 < 0 && r1 > 0) || (r0 > 0 && r1 < 0)) {
        return ignored(primitive.type, "illegal radii");
    }
    if (r0 < 0 || r1 < 0) {
        result.type = other_side(primitive.type);
        result.warning = "negative radii";
        r0 = std::abs(r0);
        r1 = std::abs(r1);
    }
    if (std::abs(r0 - r1) <= kEpsilon) {
        result.type =
            result.type == PrimitiveType::cone ? PrimitiveType::cylinder : PrimitiveType::tube;
        r1 = r0;
    }
    return make_cone_shape({point_at(primitive.reals, 0), point_at(primitive.reals, 3), r0, r1},
                           std::move(result));
}

ValidatedShape make_ring(const SurfacePrimitive& primitive) {
    expect_count(primitive, 8, "bad # arguments");
    expect_finite(primitive);
    RingShape ring{point_at(primitive.reals, 0), normalize(point_at(primitive.reals, 3)),
                   zero_if_tiny(primitive.reals[6]), zero_if_tiny(primitive.reals[7])};
    if (ring.r0 < 0 || ring.r1 < 0 || std::abs(ring.r0 - ring.r1) <= kEpsilon) {
        return ignored(primitive.type, "illegal radii");
    }
    if (ring.normal == Vec3{}) return ignored(primitive.type, "unknown orientation");
    if (ring.r0 > ring.r1) std::swap(ring.r0, ring.r1);
    return {ring, primitive.type, {}};
}

/// A zero direction stays zero: such a source contains no direction unless it is the whole sphere.
ValidatedShape make_source(const SurfacePrimitive& primitive) {
    expect_count(primitive, 4, "bad # arguments");
    expect_finite(primitive);
    const double half_angle = primitive.reals[3] * (kPi / 180) / 2;
    const auto solid_angle = static_cast<float>(2 * kPi * (1 - std::cos(half_angle)));
    return {SourceShape{normalize(point_at(primitive.reals, 0)), solid_angle}, primitive.type, {}};
}

}  // namespace

Vec3 twice_area_of(const PointList& vertices) {
    Vec3 twice_area;
    for (std::size_t i = 2; i < vertices.size(); ++i) {
        twice_area += cross(vertices[i - 1] - vertices[0], vertices[i] - vertices[0]);
    }
    return twice_area;
}

ValidatedShape make_shape(const SurfacePrimitive& primitive) {
    switch (primitive.type) {
        case PrimitiveType::source:
            return make_source(primitive);
        case PrimitiveType::sphere:
        case PrimitiveType::bubble:
            return make_sphere(primitive);
        case PrimitiveType::polygon:
            return make_polygon(primitive);
        case PrimitiveType::cone:
        case PrimitiveType::cup:
            return make_cone(primitive);
        case PrimitiveType::cylinder:
        case PrimitiveType::tube:
            return make_cylinder(primitive);
        case PrimitiveType::ring:
            return make_ring(primitive);
        default:
            return {
                std::monostate{}, primitive.type, {}};  // placements and modifiers have no shape
    }
}

}  // namespace lightwalk
