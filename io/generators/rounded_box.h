#pragma once
// A box whose rounded edges and corners are made of flat pieces.
#include <cstddef>
#include <span>
#include <string_view>

#include "io/generators/polygon_mesh.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {

struct RoundedBox {
    Vec3 size;  ///< from the origin
    double radius = 0;
    bool inward = false;       ///< normals point into the box
    bool smooth = false;       ///< triangles with normals instead of quadrilaterals for the edges
    std::size_t segments = 1;  ///< of a quarter circle; rounded up to a power of two
};

/// 6 quadrilaterals, then the 12 edges with a quadrilateral for each segment, then the 8 corners,
/// each an octant of 4^k triangles made by splitting edges at their middles.
[[nodiscard]] PolygonMesh rounded_box(const RoundedBox& box);

/// Write the texture that turns a triangle's normal into its vertices' normals, interpolated: a
/// texfunc "Phong" of tmesh.cal. False, and nothing written, for a triangle without an area.
bool write_smoothing(std::string_view modifier, std::span<const Vec3> corners,
                     std::span<const Vec3> normals, SceneWriter& out);

}  // namespace lightwalk
