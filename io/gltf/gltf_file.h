#pragma once
// glTF files (.gltf, .glb): meshes, materials, images and lights.
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/function_ref.h"
#include "core/math/vec3.h"
#include "core/model/primitive.h"
#include "io/language/material_text.h"

namespace lightwalk {

struct GltfTexture {
    std::size_t image = 0;  ///< into GltfFile::images
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
};

/// A material as the file has it; colours are linear.
struct GltfMaterial {
    using Color = std::array<double, 3>;
    enum class Alpha { opaque, mask, blend };
    std::string name;  ///< no other material of the file has it
    Color base{1, 1, 1};
    std::optional<GltfTexture> base_texture;
    double metallic = 1, roughness = 1;            ///< roughness as it is perceived
    std::optional<GltfTexture> roughness_texture;  ///< green: roughness, blue: metallic
    Color emitted{};                               ///< luminous exitance per steradian [cd/m²]
    std::optional<GltfTexture> emitted_texture;
    Alpha alpha = Alpha::opaque;
    double opacity = 1, cutoff = 0.5;
    bool unlit = false;
    double transmission = 0, ior = 1.5, thickness = 0;
    Color attenuation{1, 1, 1};       ///< what is left after attenuation_distance
    double attenuation_distance = 0;  ///< [m]; 0: nothing is absorbed
};

/// An image: a file beside, or bytes.
struct GltfImage {
    std::string uri;  ///< of the file, relative to this one; "": none
    std::string bytes;
};

/// A light (KHR_lights_punctual), without extent.
struct GltfLight {
    enum class Kind { point, spot, directional };
    Kind kind = Kind::point;
    std::array<double, 3> intensity{};  ///< [cd], or for directional ones illuminance [lx]
    Vec3 position, direction;           ///< direction: in which it shines
    double angle = 0;                   ///< of a spot's cone, from its axis [rad]
};

/// Coordinates are Radiance's: in metres, z up. (glTF's y is up: x, y, z become x, -z, y.)
struct GltfFile {
    std::vector<GltfMaterial> materials;
    std::vector<GltfImage> images;
    /// The triangles of each material, and last those without any: all nodes of the scene,
    /// transformed. Materials are void.
    std::vector<std::shared_ptr<const MeshModel>> parts;
    std::vector<GltfLight> lights;
    std::vector<std::string> left_out;  ///< what a user should know of that is not drawn
};

/// Decode a file: the scene that it calls its first, without animations, skins and morph targets.
/// Triangles that are repeated by nodes are bounded in number, everything else by the bytes.
/// @param read  the bytes of a file beside it; asked for relative paths that stay there
/// Throws InputError "NAME: ...". Source: Khronos Group, glTF 2.0 Specification.
[[nodiscard]] GltfFile decode_gltf(std::string_view bytes, const std::string& name,
                                   FunctionRef<std::string(const std::string& path)> read);

}  // namespace lightwalk
