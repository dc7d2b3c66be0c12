#include "io/scene/model_scene.h"

#include "io/scene/gltf_scene.h"
#include "io/scene/obj_scene.h"

namespace lightwalk {

bool is_model_name(const std::string& name) {
    return has_ending(name, ".obj") || has_ending(name, ".glb") || has_ending(name, ".gltf");
}

std::string read_model(const std::string& name, const std::string& path, FileSource& files,
                       const FunctionRef<bool(const std::string&)>* is_defined,
                       WarningSink& warnings) {
    if (has_ending(name, ".obj")) return obj_scene(name, path, files, is_defined, warnings);
    return gltf_scene(name, path, files, is_defined, warnings);
}

}  // namespace lightwalk
