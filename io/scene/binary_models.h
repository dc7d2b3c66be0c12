#pragma once
// Octrees and compiled meshes from bytes in memory.
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/primitive.h"

namespace lightwalk {

/// What an octree file says: its objects (frozen), or the scene files it was made from. The tree
/// itself is checked and skipped: Lightwalk builds its own acceleration structure.
struct OctreeContents {
    std::vector<std::string> scene_files;  ///< empty when frozen
    std::uint64_t objects = 0;             ///< how many primitives it was made from
    std::shared_ptr<Model> model;          ///< set when frozen
    std::vector<std::string> header;
    ModelCube cube;
};
/// Whether `bytes` begin like an octree (header with FORMAT=Radiance_octree).
[[nodiscard]] bool is_octree(std::string_view bytes);
/// Throws InputError "NAME: ..." for what is not an octree or is damaged.
[[nodiscard]] OctreeContents decode_octree(std::string_view bytes, const std::string& name);
/// A compiled mesh (.rtm) as `obj2mesh` writes it. Throws InputError "NAME: ..." for damaged files.
[[nodiscard]] MeshModel decode_mesh(std::string_view bytes, const std::string& name);

}  // namespace lightwalk
