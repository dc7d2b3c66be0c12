#include "core/virtual_source/beam.h"

#include <algorithm>

#include "core/virtual_source/projection.h"

namespace lightwalk {
namespace {

constexpr double kRound =
    1.5;  ///< margin: samples may lie outside the sampling box by less than this factor

/// Corners of a rectangle around the redirecting surface, in order.
std::array<Vec3, 4> outline(const Shape& shape, const Plane& plane, const RedirectingDisk& disk) {
    Vec3 along = perpendicular(plane.normal);
    double low_a = -disk.radius, high_a = disk.radius, low_b = low_a, high_b = high_a;
    if (const auto* polygon = std::get_if<PolygonShape>(&shape)) {
        const Vec3 edge = polygon->vertices[1] - polygon->vertices[0];
        const Vec3 flat = edge - plane.normal * dot(plane.normal, edge);
        if (length_squared(flat) > 0) along = normalize(flat);
        const Vec3 across = cross(plane.normal, along);
        low_a = low_b = kHuge;
        high_a = high_b = -kHuge;
        for (const Vec3 vertex : polygon->vertices) {
            const Vec3 from_center = vertex - disk.center;
            const double a = dot(from_center, along), b = dot(from_center, across);
            low_a = std::min(low_a, a);
            high_a = std::max(high_a, a);
            low_b = std::min(low_b, b);
            high_b = std::max(high_b, b);
        }
    }
    const Vec3 across = cross(plane.normal, along);
    const auto corner = [&](double a, double b) { return disk.center + along * a + across * b; };
    return {corner(low_a, low_b), corner(high_a, low_b), corner(high_a, high_b),
            corner(low_a, high_b)};
}

/// Corners of the sampling box; directions of a distant source.
std::array<Vec3, 8> box_of(const LightSource& source) {
    std::array<Vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
        corners[i] = source.center + source.u * (i & 1 ? kRound : -kRound) +
                     source.v * (i & 2 ? kRound : -kRound) + source.w * (i & 4 ? kRound : -kRound);
    }
    return corners;
}

/// The plane through the edge from a to b that has the lines from all corners of the source above
/// it.
std::optional<Plane> side_of_beam(const Vec3& a, const Vec3& b, const Vec3& inside,
                                  const std::array<Vec3, 8>& corners, bool distant) {
    const auto from_edge = [&](const Vec3& corner) { return distant ? corner : corner - a; };
    const auto through = [&](const Vec3& corner) {
        const Vec3 normal = normalize(cross(b - a, from_edge(corner)));
        return dot(normal, inside - a) < 0 ? -normal : normal;
    };
    Vec3 normal = through(corners[0]);
    for (const Vec3& corner : corners) {
        if (dot(normal, from_edge(corner)) > 0) normal = through(corner);
    }
    if (!(length_squared(normal) > 0)) return std::nullopt;
    return Plane{normal, dot(normal, a)};
}

}  // namespace

std::optional<VirtualSourceBeam> virtual_source_beam(const LightSource& source,
                                                     const Shape& surface) {
    const auto plane = plane_of(surface);
    const auto disk = redirecting_disk(surface);
    if (!plane || !disk) return std::nullopt;
    const std::array<Vec3, 8> corners = box_of(source);
    int above = 0, below = 0;
    for (const Vec3& corner : corners) {
        const double height =
            source.is_distant() ? dot(plane->normal, corner) : plane->height(corner);
        above += height > kEpsilon ? 1 : 0;
        below += height < -kEpsilon ? 1 : 0;
    }
    if (above != 8 && below != 8) return std::nullopt;
    VirtualSourceBeam beam;
    beam.surface = above == 8 ? *plane : Plane{-plane->normal, -plane->offset};
    const std::array<Vec3, 4> edge = outline(surface, *plane, *disk);
    const Vec3 inside = (edge[0] + edge[2]) * 0.5;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto side =
            side_of_beam(edge[i], edge[(i + 1) % 4], inside, corners, source.is_distant());
        if (!side) return std::nullopt;
        beam.sides[i] = *side;
    }
    return beam;
}

}  // namespace lightwalk
