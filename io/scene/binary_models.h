#pragma once
// Decodes octrees and compiled meshes from bytes in memory.
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/primitive.h"

namespace lightwalk {

/// The contents of an octree file: the objects of a frozen one, or the names of the scene files
/// that it was made from. The tree is checked and skipped, as Lightwalk builds its own acceleration
/// structure.
struct OctreeContents {
    std::vector<std::string> scene_files;  ///< empty when frozen
    std::uint64_t objects = 0;             ///< number of primitives that it was made from
    std::shared_ptr<Model> model;          ///< set when frozen
    std::vector<std::string> header;
    ModelCube cube;
};
/// Whether `bytes` begin with the header of an octree (FORMAT=Radiance_octree).
[[nodiscard]] bool is_octree(std::string_view bytes);
/// Decode an octree. Throws InputError "NAME: ..." for other and for damaged files.
[[nodiscard]] OctreeContents decode_octree(std::string_view bytes, const std::string& name);
/// Decode a compiled mesh (.rtm) of `obj2mesh`. Throws InputError "NAME: ..." for damaged files.
[[nodiscard]] MeshModel decode_mesh(std::string_view bytes, const std::string& name);

}  // namespace lightwalk
