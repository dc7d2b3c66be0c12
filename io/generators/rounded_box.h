#pragma once
// A box with rounded edges and corners, as a polygon mesh.
#include <cstddef>
#include <span>
#include <string_view>

#include "io/generators/polygon_mesh.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {

struct RoundedBox {
    Vec3 size;  ///< the corner opposite to the origin
    double radius = 0;
    bool inward = false;       ///< normals point into the box
    bool smooth = false;       ///< edges are triangles with normals instead of quadrilaterals
    std::size_t segments = 1;  ///< of a quarter circle; rounded up to a power of two
};

/// The mesh of a box: 6 faces, then 12 edges with a quadrilateral for each segment, then 8 corners,
/// each an octant of a sphere of 4^k triangles, made by k subdivisions at the middles of edges.
[[nodiscard]] PolygonMesh rounded_box(const RoundedBox& box);

/// Write the texture that replaces a triangle's normal by the interpolated normals of its vertices:
/// a texfunc "Phong" of tmesh.cal. False, and nothing is written, for a triangle of no area.
bool write_smoothing(std::string_view modifier, std::span<const Vec3> corners,
                     std::span<const Vec3> normals, SceneWriter& out);

}  // namespace lightwalk
