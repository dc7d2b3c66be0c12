#pragma once
// A mesh as Radiance's obj2mesh makes it of an object file.
#include <optional>
#include <string>

#include "core/model/primitive.h"
#include "io/wavefront/obj_file.h"

namespace lightwalk {

/// The faces of an object file as a mesh without materials: smoothed where all corners of a
/// triangle have normals, with texture coordinates where they have those.
/// @param material  the faces of this material alone (ObjFile::material_of); nothing: all faces,
///                  each with the index of its name among `materials`
/// @param materials  the mesh's own; names that it lacks, or all without it, are void
[[nodiscard]] MeshModel mesh_of_obj(const ObjFile& file, const std::optional<std::string>& material,
                                    Model materials);

}  // namespace lightwalk
