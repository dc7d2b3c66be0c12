#pragma once
// Faces with shared vertices: what generators write as a Wavefront .OBJ.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec3.h"

namespace lightwalk {

/// Vertices and faces. Texture coordinates and normals belong to vertices; they are given for all
/// of them or for none.
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

/// The mesh as .OBJ text: usemtl, o, v, vt, vn, f; indices count backwards from the last vertex, so
/// that files can be joined. Throws InputError when it is larger than kMaxGeneratedBytes, and for
/// numbers that are not finite. Source: Wavefront, "Object files (.obj)", Advanced Visualizer
/// manual, app. B1.
[[nodiscard]] std::string write_obj(std::span<const std::string> args, const std::string& material,
                                    const std::string& name, const PolygonMesh& mesh);

}  // namespace lightwalk
