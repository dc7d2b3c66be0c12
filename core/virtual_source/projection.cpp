#include "core/virtual_source/projection.h"

#include <cmath>

#include "core/light/spot.h"

namespace lightwalk {
namespace {

constexpr double kSquareToDisk =
    1.12837917;  ///< half width of a disk around a square of equal area

/// How far a round source reaches beyond its sampling box.
double overhang(const LightSource& source) {
    if (!source.is_round()) return 1;
    return source.is_flat() || source.is_distant() ? kSquareToDisk : 1 / kSphereBox;
}

VirtualSpot impossible() {
    return {false, std::nullopt, {}};
}

/// The beam of a distant source through the disk, and through the parent's beam.
VirtualSpot spot_of_beam(const LightSource& parent, const LightSource& projected,
                         const Projection& projection, const RedirectingDisk& disk) {
    SpotShape beam;
    beam.beam = true;
    beam.aim = disk.center;
    beam.size = static_cast<float>(kPi * disk.radius * disk.radius);
    if (!parent.spot || !parent.spot->beam) return {true, beam, disk};
    SpotShape before = *parent.spot;
    before.aim = projection.point(before.aim);
    const double spread = static_cast<double>(parent.radius) * length(beam.aim - before.aim);
    const double radius = std::sqrt(static_cast<double>(before.size) / kPi) + spread;
    before.size = static_cast<float>(kPi * radius * radius);
    const auto common = intersect_beams(beam, before, projected.center);
    if (!common) return impossible();
    return {true, common, disk};
}

/// The cone around a disk from a local source; nothing when the source is too near for a bound.
std::optional<SpotShape> cone_around(const LightSource& source, const RedirectingDisk& disk,
                                     double distance) {
    const double sine = (disk.radius + static_cast<double>(source.radius)) / distance;
    if (sine >= 1 - kEpsilon) return std::nullopt;
    SpotShape cone;
    cone.aim = (disk.center - source.center) / distance;
    cone.size = static_cast<float>(cone_solid_angle(std::sqrt(1 - sine * sine)));
    return cone;
}

VirtualSpot spot_of_cone(const LightSource& parent, const LightSource& projected,
                         const Projection& projection, const RedirectingDisk& disk) {
    const double distance = length(disk.center - projected.center);
    if (distance <= 0) return impossible();
    if (projected.material_type == PrimitiveType::glow &&
        distance > static_cast<double>(projected.proximity)) {
        return impossible();
    }
    VirtualSpot redirected{true, cone_around(projected, disk, distance), disk};
    if (parent.spot) {
        SpotShape before = *parent.spot;
        before.aim = normalize(projection.vector(before.aim));
        if (redirected.spot) {
            const auto common = intersect_cones(*redirected.spot, before);
            if (!common) return impossible();
            if (common->size < redirected.spot->size) {
                const double cosine = 1 - static_cast<double>(common->size) / (2 * kPi);
                const double tangent = std::sqrt(std::max(0.0, 1 / (cosine * cosine) - 1));
                redirected.disk.radius = std::min(disk.radius, distance * tangent);
                redirected.disk.center = projected.center + common->aim * distance;
            }
            redirected.spot = common;
        } else {
            redirected.spot = before;
        }
    }
    if (projected.is_flat() && redirected.spot && !spot_faces(*redirected.spot, projected.normal))
        return impossible();
    return redirected;
}

}  // namespace

std::optional<Plane> plane_of(const Shape& shape) {
    if (const auto* polygon = std::get_if<PolygonShape>(&shape))
        return Plane{polygon->normal, polygon->offset};
    if (const auto* ring = std::get_if<RingShape>(&shape))
        return Plane{ring->normal, dot(ring->normal, ring->center)};
    return std::nullopt;
}

bool Projection::is_identity() const {
    for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            if (std::abs(plane_.normal[row] * shear_[column]) > kEpsilon) return false;
        }
        if (std::abs(plane_.offset * shear_[column]) > kEpsilon) return false;
    }
    return true;
}

std::optional<Projection> Projection::bend(const Plane& plane, const Vec3& from, const Vec3& to) {
    const double a = dot(from, plane.normal), b = dot(to, plane.normal);
    if (std::abs(a) <= kEpsilon || std::abs(b) <= kEpsilon) return std::nullopt;
    Vec3 shear = to / b - from / a;
    if ((a > 0) != (b > 0)) shear -= plane.normal * 2.0;
    const Projection projection{plane, shear};
    if (projection.is_identity()) return std::nullopt;
    return projection;
}

std::optional<RedirectingDisk> redirecting_disk(const Shape& shape) {
    if (const auto* ring = std::get_if<RingShape>(&shape))
        return RedirectingDisk{ring->center, ring->r1};
    const auto* polygon = std::get_if<PolygonShape>(&shape);
    if (!polygon) return std::nullopt;
    RedirectingDisk disk;
    for (const Vec3 p : polygon->vertices) disk.center += p;
    disk.center = disk.center / static_cast<double>(polygon->vertices.size());
    disk.center += polygon->normal * (polygon->offset - dot(polygon->normal, disk.center));
    for (const Vec3 p : polygon->vertices)
        disk.radius = std::max(disk.radius, length(p - disk.center));
    return disk;
}

bool is_before_mirror(const LightSource& source, const Plane& plane) {
    // Radiance steps along each half axis by comparing its projection with the plane's offset, not
    // with zero. The point that is reached is not always the foremost one: a lamp that is sunk into
    // a mirror's plane may get no image. Its pictures show that, so ours do.
    const double offset = source.is_distant() ? 0 : plane.offset;
    double reached = dot(plane.normal, source.center);
    const auto step = [&](const Vec3& axis) {
        const double along = dot(plane.normal, axis);
        reached += (along > offset ? 1 : -1) * overhang(source) * along;
    };
    step(source.u);
    step(source.v);
    if (!source.is_flat()) step(source.w);
    return reached > offset + kEpsilon;
}

LightSource project(const LightSource& source, const Projection& projection) {
    LightSource projected = source;
    projected.center = source.is_distant() ? normalize(projection.vector(source.center))
                                           : projection.point(source.center);
    projected.u = projection.vector(source.u);
    projected.v = projection.vector(source.v);
    projected.w = projection.vector(source.w);
    if (source.is_flat()) projected.normal = normalize(projection.vector(source.normal));
    return projected;
}

VirtualSpot virtual_spot(const LightSource& parent, const LightSource& projected,
                         const Projection& projection, const RedirectingDisk& disk) {
    return projected.is_distant() ? spot_of_beam(parent, projected, projection, disk)
                                  : spot_of_cone(parent, projected, projection, disk);
}

}  // namespace lightwalk
