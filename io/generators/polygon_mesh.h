#pragma once
// Polygon meshes with shared vertices, which generators write as Wavefront .OBJ.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec3.h"

namespace lightwalk {

/// A mesh of triangles and quadrilaterals. All vertices have texture coordinates, or none; likewise
/// normals.
struct PolygonMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<std::array<double, 2>> uvs;
    struct Face {
        std::array<std::uint32_t, 4> vertex{};
        std::size_t corners = 0;  ///< 3 or 4
    };
    std::vector<Face> faces;
};

/// A mesh as .OBJ text with the statements usemtl, o, v, vt, vn, f. Indices are negative, counted
/// from the last vertex, so that files can be concatenated. Throws InputError for a text larger
/// than kMaxGeneratedBytes, and for numbers that are not finite. Source: Wavefront, "Object files
/// (.obj)", Advanced Visualizer manual, app. B1.
[[nodiscard]] std::string write_obj(std::span<const std::string> args, const std::string& material,
                                    const std::string& name, const PolygonMesh& mesh);

}  // namespace lightwalk
