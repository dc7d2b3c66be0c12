#pragma once
// Cones of spotlights, beams of redirected sunlight, and where two of them overlap.
#include <optional>

#include "core/light/light_source.h"

namespace lightwalk {

/// Whether a ray that runs towards the source, from `origin` along the unit vector `direction`, is
/// outside the cone or beam: then no light comes that way.
[[nodiscard]] bool outside_spot(const SpotShape& spot, const Vec3& origin, const Vec3& direction);

/// Whether the cone of a flat source with this normal sends anything to the source's front.
[[nodiscard]] bool spot_faces(const SpotShape& spot, const Vec3& normal);

/// Solid angle of a cone of half angle `theta`, given its cosine: 2π(1 - cos θ) [sr].
[[nodiscard]] inline double cone_solid_angle(double cos_theta) {
    return 2 * kPi * (1 - cos_theta);
}

/// The cone of a spotlight's arguments (colour, full angle in degrees, direction whose length is
/// the focal length). Throws InputError for an angle or a direction that is zero.
[[nodiscard]] SpotShape spot_cone(const Primitive& spotlight);

/// A disk whose plane is known from elsewhere.
struct Disk {
    Vec3 center;
    double radius_squared = 0;
};

/// The disk around the overlap of two disks whose centres are `separation` apart (a vector in their
/// common plane, from a to b): the smaller one when it lies in the other, else the disk on their
/// common chord. Nothing when they do not overlap.
[[nodiscard]] std::optional<Disk> intersect_disks(const Disk& a, const Disk& b,
                                                  const Vec3& separation);

/// The part of beam `b` that is also in beam `a`, both along the unit vector `direction`.
[[nodiscard]] std::optional<SpotShape> intersect_beams(const SpotShape& a, const SpotShape& b,
                                                       const Vec3& direction);

/// The part of cone `narrow` that is also in cone `wide`; the focal length of `wide` is kept. A
/// `wide` cone of a hemisphere or more only has to overlap.
[[nodiscard]] std::optional<SpotShape> intersect_cones(const SpotShape& narrow,
                                                       const SpotShape& wide);

}  // namespace lightwalk
