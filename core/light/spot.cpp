#include "core/light/spot.h"

#include <cmath>

namespace lightwalk {
namespace {

double cosine(const SpotShape& cone) {
    return 1 - static_cast<double>(cone.size) / (2 * kPi);
}

/// Squared radius of a cone's cut through the plane that touches the unit sphere at its axis.
double tangent_squared(const SpotShape& cone) {
    const double c = cosine(cone);
    return 1 / (c * c) - 1;
}

/// Whether the axes are closer than the sum of the half angles.
bool cones_overlap(const SpotShape& a, const SpotShape& b) {
    const double ca = cosine(a), cb = cosine(b);
    const double sa = std::sqrt(std::max(0.0, 1 - ca * ca)),
                 sb = std::sqrt(std::max(0.0, 1 - cb * cb));
    return dot(a.aim, b.aim) >= ca * cb - sa * sb;
}

}  // namespace

bool outside_spot(const SpotShape& spot, const Vec3& origin, const Vec3& direction) {
    const auto size = static_cast<double>(spot.size);
    if (!spot.beam) return size < 2 * kPi * (1 + dot(spot.aim, direction));
    const Vec3 to_axis = spot.aim - origin;
    const double along = dot(to_axis, direction);
    return kPi * (length_squared(to_axis) - along * along) > size;
}

bool spot_faces(const SpotShape& spot, const Vec3& normal) {
    const double a = dot(spot.aim, normal), c = cosine(spot);
    return a > kEpsilon || c < 0 || -a < std::sqrt(1 - c * c) - kEpsilon;
}

SpotShape spot_cone(const Primitive& spotlight) {
    const auto refuse = [&](const char* problem) {
        return InputError(spotlight.where, std::string(to_string(spotlight.type)) + " \"" +
                                               spotlight.name + "\": " + problem);
    };
    const std::vector<double>& reals = spotlight.reals;
    if (!(reals[3] > kEpsilon)) throw refuse("zero angle");
    const Vec3 direction{reals[4], reals[5], reals[6]};
    const double focal_length = length(direction);
    if (!(focal_length > 0)) throw refuse("zero direction");
    SpotShape spot;
    spot.aim = direction / focal_length;
    spot.size = static_cast<float>(cone_solid_angle(std::cos(reals[3] * kPi / 360)));
    spot.focal_length = static_cast<float>(focal_length);
    return spot;
}

std::optional<Disk> intersect_disks(const Disk& a, const Disk& b, const Vec3& separation) {
    const double apart = length_squared(separation);
    const double ra = a.radius_squared, rb = b.radius_squared;
    const double difference = std::sqrt(ra) - std::sqrt(rb);
    if (difference * difference >= apart) return ra <= rb ? a : b;
    const double excess = rb - ra;
    const double chord = 0.25 * (2 * (ra + rb) - apart - excess * excess / apart);
    if (chord <= 0) return std::nullopt;
    return Disk{a.center + separation * std::sqrt(std::max(0.0, ra - chord) / apart), chord};
}

std::optional<SpotShape> intersect_beams(const SpotShape& a, const SpotShape& b,
                                         const Vec3& direction) {
    const Vec3 between = b.aim - a.aim;
    const Vec3 across = between - direction * dot(between, direction);
    const auto overlap = intersect_disks({a.aim, static_cast<double>(a.size) / kPi},
                                         {b.aim, static_cast<double>(b.size) / kPi}, across);
    if (!overlap) return std::nullopt;
    SpotShape common = a;
    common.aim = overlap->center;
    common.size = static_cast<float>(kPi * overlap->radius_squared);
    return common;
}

std::optional<SpotShape> intersect_cones(const SpotShape& narrow, const SpotShape& wide) {
    SpotShape common = narrow;
    common.focal_length = wide.focal_length;
    if (static_cast<double>(wide.size) >= 2 * kPi - kEpsilon) {
        if (!cones_overlap(narrow, wide)) return std::nullopt;
        return common;
    }
    const auto overlap = intersect_disks({narrow.aim, tangent_squared(narrow)},
                                         {wide.aim, tangent_squared(wide)}, wide.aim - narrow.aim);
    if (!overlap) return std::nullopt;
    common.aim = normalize(overlap->center);
    common.size = static_cast<float>(cone_solid_angle(1 / std::sqrt(1 + overlap->radius_squared)));
    return common;
}

}  // namespace lightwalk
