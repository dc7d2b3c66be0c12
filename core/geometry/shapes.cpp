#include "core/geometry/shapes.h"

#include <array>
#include <cmath>

#include "core/geometry/polygon.h"

namespace lightwalk {
namespace {

/// Ascending real roots of a quadratic.
struct Roots {
    std::array<double, 2> t{};
    int count = 0;
};

/// Roots of a t² + 2 h t + c with half coefficient h, where disc = h² - a c is given. A
/// discriminant within kEpsilon² of zero counts as one root. Where `a` is tiny (a ray along a
/// cone's axis or side), the form c / q keeps the near root accurate: Radiance's linear formula
/// would leave the surface.
Roots solve_quadratic(double a, double h, double c, double disc) {
    if (!(disc >= -kEpsilon * kEpsilon)) return {};
    if (std::abs(a) <= kEpsilon) {
        if (std::abs(h) <= kEpsilon / 2 || disc < 0) return {};
        const double q = h > 0 ? -h - std::sqrt(disc) : -h + std::sqrt(disc);
        const double near = c / q;
        if (a == 0) return {{near}, 1};
        const double far = q / a;
        return near < far ? Roots{{near, far}, 2} : Roots{{far, near}, 2};
    }
    if (disc <= kEpsilon * kEpsilon) return {{-h / a}, 1};
    const double width = std::sqrt(disc);
    return a > 0 ? Roots{{(-h - width) / a, (-h + width) / a}, 2}
                 : Roots{{(-h + width) / a, (-h - width) / a}, 2};
}

std::optional<ShapeHit> intersect(const SphereShape& sphere, const Vec3& origin,
                                  const Vec3& direction, double t_max) {
    const Vec3 to_center = sphere.center - origin;
    const double t_closest = dot(to_center, direction);
    const Vec3 miss =
        direction * t_closest - to_center;  // from the centre to the nearest point of the line
    const double c = length_squared(miss) - sphere.radius * sphere.radius;
    const double a = length_squared(direction);
    const Roots roots = solve_quadratic(a, 0, c, -a * c);
    for (int i = 0; i < roots.count; ++i) {
        const double s = roots.t[static_cast<std::size_t>(i)];
        const double t = t_closest + s;
        if (!(t > kEpsilon)) continue;
        if (!(t <= t_max)) return std::nullopt;
        const Vec3 outward = normalize(miss + direction * s);
        return ShapeHit{t, sphere.inward ? -outward : outward, (i == 0) != sphere.inward};
    }
    return std::nullopt;
}

Vec3 cone_normal(const ConeShape& cone, const Vec3& from_p0, double height) {
    const Vec3 radial = normalize(from_p0 - cone.axis * height);
    // At the apex the normal is undefined: it points away from the body.
    Vec3 outward = -cone.axis;
    if (radial != Vec3{})
        outward = normalize(radial * cone.length - cone.axis * (cone.r1 - cone.r0));
    return cone.inward ? -outward : outward;
}

std::optional<ShapeHit> intersect(const RingShape& ring, const Vec3& origin, const Vec3& direction,
                                  double t_max) {
    const double cosine = dot(ring.normal, direction);
    if (!(std::abs(cosine) > kEpsilon)) return std::nullopt;
    const double t = dot(ring.normal, ring.center - origin) / cosine;
    if (!(t > kEpsilon && t <= t_max)) return std::nullopt;
    const double distance_squared = length_squared(origin + direction * t - ring.center);
    if (!(distance_squared >= ring.r0 * ring.r0 && distance_squared <= ring.r1 * ring.r1))
        return std::nullopt;
    return ShapeHit{t, ring.normal, cosine < 0};
}

}  // namespace

std::optional<ShapeHit> intersect(const ConeShape& cone, const Vec3& origin, const Vec3& direction,
                                  double t_max) {
    // Measured from the line's point nearest to p0, so that a far origin costs no precision.
    const double t_near = dot(cone.p0 - origin, direction);
    const Vec3 start = origin + direction * t_near - cone.p0;
    const double height = dot(start, cone.axis), climb = dot(direction, cone.axis);
    const Vec3 radial = start - cone.axis * height, spread = direction - cone.axis * climb;
    const double radius = cone.r0 + cone.slope * height, growth = cone.slope * climb;
    const double a = length_squared(spread) - growth * growth;
    const double h = dot(radial, spread) - radius * growth;
    const double c = length_squared(radial) - radius * radius;
    const Roots roots = solve_quadratic(a, h, c, h * h - a * c);
    for (int i = 0; i < roots.count; ++i) {
        const double s = roots.t[static_cast<std::size_t>(i)];
        const double t = t_near + s;
        if (!(t > kEpsilon)) continue;
        if (!(t <= t_max)) return std::nullopt;
        const double along = height + climb * s;
        if (!(along >= 0 && along <= cone.length)) continue;
        return ShapeHit{t, cone_normal(cone, start + direction * s, along),
                        (i == 0) != cone.inward};
    }
    return std::nullopt;
}

std::optional<ShapeHit> intersect(const Shape& shape, const Vec3& origin, const Vec3& direction,
                                  double t_max) {
    if (const auto* polygon = std::get_if<PolygonShape>(&shape)) {
        return intersect(*polygon, origin, direction, t_max, nullptr);
    }
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return intersect(*sphere, origin, direction, t_max);
    if (const auto* cone = std::get_if<ConeShape>(&shape))
        return intersect(*cone, origin, direction, t_max);
    if (const auto* ring = std::get_if<RingShape>(&shape))
        return intersect(*ring, origin, direction, t_max);
    return std::nullopt;  // nothing, or a source at infinity
}

}  // namespace lightwalk
