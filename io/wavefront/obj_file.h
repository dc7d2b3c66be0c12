#pragma once
// Wavefront object files (.obj): polygons with texture coordinates, normals and names of materials.
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"

namespace lightwalk {

struct ObjFile {
    static constexpr std::uint32_t kNone = 0xffffffff;
    struct Corner {
        std::uint32_t position = 0, uv = kNone, normal = kNone;  ///< indices, or kNone
        friend bool operator==(const Corner&, const Corner&) = default;
    };
    struct Face {
        std::uint32_t first = 0, count = 0;                             ///< its corners, at least 3
        std::uint32_t material = kNone, group = kNone, object = kNone;  ///< indices of names
        std::uint32_t groups = kNone;  ///< index of the name that is all of its groups
        std::int32_t line = 0;
    };
    std::vector<Vec3> positions, normals;  ///< normals are unit vectors
    std::vector<std::array<double, 2>> uvs;
    std::vector<Corner> corners;
    std::vector<Face> faces;
    std::vector<std::string> names;  ///< of usemtl, g and o
    /// What stands behind usemtl, usemap, g and o, each once, whether faces use it or not.
    std::set<std::string> material_names, map_names, group_names, object_names;
    std::vector<std::string> libraries;  ///< of mtllib

    [[nodiscard]] std::span<const Corner> corners_of(const Face& face) const {
        return std::span(corners).subspan(face.first, face.count);
    }
    /// usemtl's name, or else the group's; "" when there is neither.
    [[nodiscard]] const std::string& material_of(const Face& face) const;
};

/// Decode a file: v, vn, vt, f, g, o, usemtl and mtllib; other statements are skipped. Throws
/// InputError "NAME:LINE: ...". Source: Wavefront, "Object files (.obj)", Advanced Visualizer
/// manual, app. B1; Radiance's manual page obj2mesh(1).
[[nodiscard]] ObjFile decode_obj(std::string_view text, const std::string& name);

/// Three places in a face's list of corners.
using ObjTriangle = std::array<std::uint32_t, 3>;

/// A face in triangles: ears are cut off at its plane's convex corners, so concave faces are
/// covered, too. Without triangles that have no area.
/// @param first  the corner that is cut off first, if it is convex; then every second one. Radiance
///               takes 0 for meshes (obj2mesh), 1 for polygons (obj2rad)
[[nodiscard]] std::vector<ObjTriangle> triangulate(const ObjFile& file, const ObjFile::Face& face,
                                                   std::size_t first);

}  // namespace lightwalk
