#pragma once
// What decode_gltf consists of.
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/gltf_file.h"
#include "io/gltf/tiny_gltf.h"

namespace lightwalk {

/// The container and its JSON, with all buffers. Throws InputError.
[[nodiscard]] tinygltf::Model load_gltf(std::string_view bytes, const std::string& name,
                                        FunctionRef<std::string(const std::string& path)> read);

/// A material, and what its mesh has to know: which set of texture coordinates it uses, and how
/// they are transformed (KHR_texture_transform).
struct GltfSurface {
    GltfMaterial material;
    int uv_set = 0;
    std::array<double, 2> uv_offset{}, uv_scale{1, 1};
    double uv_rotation = 0;  ///< [rad]
};
[[nodiscard]] std::vector<GltfSurface> gltf_surfaces(const tinygltf::Model& model,
                                                     const std::string& name);

[[nodiscard]] std::vector<GltfImage> gltf_images(const tinygltf::Model& model,
                                                 const std::string& name);

/// Fills parts and lights. Throws InputError.
void add_gltf_nodes(const tinygltf::Model& model, const std::vector<GltfSurface>& surfaces,
                    const std::string& name, std::size_t most_triangles, GltfFile& file);

/// The bytes of a view of a buffer. Throws InputError for one that is not there.
[[nodiscard]] std::string_view gltf_view(const tinygltf::Model& model, int view,
                                         const std::string& name);

/// A number of an extension's member that may be missing; not finite ones are `otherwise`, too.
[[nodiscard]] double gltf_number(const tinygltf::Value& object, const char* member,
                                 double otherwise);

}  // namespace lightwalk
