#pragma once
// glTF files (.gltf, .glb) as parts of scenes.
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/math/function_ref.h"
#include "core/model/primitive.h"
#include "io/files/library_path.h"
#include "io/gltf/gltf_file.h"
#include "io/scene/picture_file.h"

namespace lightwalk {

/// What a scene calls FILE.glb, or FILE.glb#PART: the number of a material as a mesh, `imageN` or
/// `imageN#alpha` as a picture.
struct GltfName {
    std::string file;
    std::optional<std::string> part;
};
/// Nothing for names of other files.
[[nodiscard]] std::optional<GltfName> gltf_name(const std::string& name);

[[nodiscard]] GltfFile read_gltf(const std::string& path, FileSource& files);

/// The scene that a glTF file is when it is named as one: for each of its materials a mesh whose
/// modifier is what the scene has so far defined by the material's name, or else the file's
/// (gltf_material_scene), which becomes part of the scene as FILE#NAME. What has no material is as
/// an object file's. Materials that emit and have few triangles are polygons: lights. Images are
/// read in place.
/// @param name  as the scene names it; `path`: where it is read
/// @param is_defined  null: nothing is
[[nodiscard]] std::string gltf_scene(const std::string& name, const std::string& path,
                                     FileSource& files,
                                     const FunctionRef<bool(const std::string&)>* is_defined,
                                     WarningSink& warnings);

/// What the parts of a file are, by what follows the '#'. Throws InputError for none.
[[nodiscard]] std::shared_ptr<const MeshModel> gltf_part(const GltfFile& file,
                                                         const std::string& path,
                                                         const std::string& part);
[[nodiscard]] PictureFile gltf_picture(const GltfFile& file, const std::string& path,
                                       const std::string& part);

/// All of a file as one mesh, with its materials.
/// @param shown  how the scene names the file
[[nodiscard]] MeshModel gltf_whole(const GltfFile& file, const std::string& path,
                                   const std::string& shown, const LibraryPath& library,
                                   WarningSink& warnings);

}  // namespace lightwalk
