#pragma once
// Files of other programs that are scenes by themselves: object files and glTF files.
#include <string>

#include "core/error.h"
#include "core/math/function_ref.h"
#include "io/files/file_source.h"

namespace lightwalk {

/// Whether the name is that of an object file (.obj) or of a glTF file (.gltf, .glb).
[[nodiscard]] bool is_model_name(const std::string& name);

/// The scene that such a file is (obj_scene, gltf_scene).
/// @param name        as the scene names it; `path`: where it is read
/// @param is_defined  which names the scene has defined by then; null: that is not known, so what
///                    the file lacks is left to the scene
[[nodiscard]] std::string read_model(const std::string& name, const std::string& path,
                                     FileSource& files,
                                     const FunctionRef<bool(const std::string&)>* is_defined,
                                     WarningSink& warnings);

}  // namespace lightwalk
