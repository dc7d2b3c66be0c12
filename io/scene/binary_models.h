#pragma once
// Octrees and compiled meshes from bytes in memory.
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/primitive.h"

namespace lightwalk {

/// What an octree file says: its objects (frozen), or the scene files it was made from. The tree itself is
/// checked and skipped: Lightwalk builds its own acceleration structure.
struct OctreeContents {
    std::vector<std::string> scene_files;  ///< empty when frozen
    std::shared_ptr<Model> model;          ///< set when frozen
    std::vector<std::string> header;
};
/// Whether `bytes` begin like an octree (header with FORMAT=Radiance_octree).
[[nodiscard]] bool is_octree(std::string_view bytes);
[[nodiscard]] OctreeContents decode_octree(std::string_view bytes, const std::string& name);
[[nodiscard]] MeshModel decode_mesh(std::string_view bytes, const std::string& name);

}  // namespace lightwalk
