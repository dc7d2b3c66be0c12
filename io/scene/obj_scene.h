#pragma once
// Object files (.obj) as parts of scenes.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/math/function_ref.h"
#include "core/model/primitive.h"
#include "io/files/library_path.h"
#include "io/wavefront/obj_file.h"

namespace lightwalk {

/// Whether a name ends so, upper and lower case alike; `ending` is in lower case.
[[nodiscard]] bool has_ending(std::string_view name, std::string_view ending);

/// What stands between an object file and the material whose faces are meant.
inline constexpr char kObjPart = '#';

/// What faces without a material have when the scene does not define it.
inline constexpr std::string_view kNoMaterial = "white";
/// A diffuse material of reflectance 0.5.
[[nodiscard]] std::string no_material_scene(const std::string& name);

/// What a mesh primitive calls FILE.obj, or FILE.obj#MATERIAL.
struct ObjName {
    std::string file;
    std::optional<std::string> material;
};
/// Nothing for names of other files.
[[nodiscard]] std::optional<ObjName> obj_name(const std::string& name);

/// The names of the materials of its faces, in the order of their first use.
[[nodiscard]] std::vector<std::string> materials_of(const ObjFile& file);

/// The scene that an object file is when it is named as one: for each of its materials a mesh
/// (kObjPart) whose modifier is what the scene has so far defined by that name, or else the
/// material of the file's mtllib (mtl_scene), which becomes part of the scene as FILE#NAME. Faces
/// that name no material, nor a group of a material's name, are "white", of reflectance 0.5 when
/// nothing defines that. Throws InputError for a material that nothing defines.
/// @param name  as the scene names it; `path`: where it is read
/// @param is_defined  null: what the file lacks is left to the scene
[[nodiscard]] std::string obj_scene(const std::string& name, const std::string& path,
                                    FileSource& files,
                                    const FunctionRef<bool(const std::string&)>* is_defined,
                                    WarningSink& warnings);

/// The materials of its mtllib that the faces use.
/// @param shown  the directory by which the scene names files beside it
[[nodiscard]] Model obj_materials(const ObjFile& file, const std::string& path,
                                  const std::string& shown, const LibraryPath& library,
                                  WarningSink& warnings);

}  // namespace lightwalk
