#pragma once
// Where a mirror or prism makes a light source appear: planes, projections, and the disk that light
// passes.
#include <optional>

#include "core/geometry/surface.h"
#include "core/light/light_source.h"
#include "core/math/plane.h"

namespace lightwalk {

/// The plane of a polygon or ring; nothing for other shapes.
[[nodiscard]] std::optional<Plane> plane_of(const Shape& shape);

/// Affine map that leaves a plane's points where they are: x -> x + height(x) k.
class Projection {
  public:
    /// Reflection in the plane.
    static Projection mirror(const Plane& plane) { return {plane, plane.normal * -2.0}; }
    /// The shear that makes light travelling along `from` look as if it had always travelled along
    /// `to` (of any lengths). Nothing when either is parallel to the plane, or when they are the
    /// same direction.
    static std::optional<Projection> bend(const Plane& plane, const Vec3& from, const Vec3& to);

    [[nodiscard]] Vec3 point(const Vec3& x) const { return x + shear_ * plane_.height(x); }
    [[nodiscard]] Vec3 vector(const Vec3& x) const { return x + shear_ * dot(plane_.normal, x); }

  private:
    Projection(const Plane& plane, const Vec3& shear) : plane_(plane), shear_(shear) {}
    [[nodiscard]] bool is_identity() const;
    Plane plane_;
    Vec3 shear_;  ///< k
};

/// Disk around a flat redirecting surface, in its plane.
struct RedirectingDisk {
    Vec3 center;
    double radius = 0;  ///< [m]
};

/// The disk of a polygon (around its vertices' average) or ring; nothing for other shapes.
[[nodiscard]] std::optional<RedirectingDisk> redirecting_disk(const Shape& shape);

/// Whether any part of the source's sampling box is in front of a mirror's plane.
[[nodiscard]] bool is_before_mirror(const LightSource& source, const Plane& plane);

/// The source as it appears through the redirecting surface: box, normal and direction projected;
/// the rest copied.
[[nodiscard]] LightSource project(const LightSource& source, const Projection& projection);

/// The cone or beam of a virtual source, limited by the outline of its redirecting surface.
struct VirtualSpot {
    bool possible = true;           ///< false: no light gets through
    std::optional<SpotShape> spot;  ///< cone or beam; nothing: no bound
    RedirectingDisk disk;  ///< the redirecting surface's disk, smaller when the spot shrank
};

/// Limit the spot of a virtual source. @param parent     the source whose light is redirected
/// @param projected  `parent` as it appears through the redirecting surface
/// @param projection how it was projected
/// @param disk       around the redirecting surface
[[nodiscard]] VirtualSpot virtual_spot(const LightSource& parent, const LightSource& projected,
                                       const Projection& projection, const RedirectingDisk& disk);

}  // namespace lightwalk
