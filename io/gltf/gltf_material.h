#pragma once
// The Radiance materials that stand for those of glTF files.
#include <optional>
#include <string>

#include "io/gltf/gltf_file.h"

namespace lightwalk {

/// The pictures of a material, as the scene calls them; what is missing is left out.
struct GltfPictures {
    std::optional<TexturePicture> base, opacity, emitted;
};

/// A material, as scene text. With F0 = ((ior - 1) / (ior + 1))², 0.04 for most, roughness² as the
/// width of Ward's lobe, and metallic and roughness as the factors times the means of their
/// texture:
/// * metallic of half and more: `metal` of the base colour, whose specular part is metallic.
/// * else `plastic`: diffuse base colour, times 1 - metallic, and specular F0, towards the base
///   colour's brightness with metallic. KHR_materials_unlit: diffuse alone.
/// * KHR_materials_transmission: `glass` where nine tenths and more pass smoothly, else `trans`;
///   with a thickness (KHR_materials_volume) and smooth, `dielectric` that absorbs.
/// * base colour texture: `colorpict` that multiplies.
/// * emission [cd/m²], divided by 179 lm/W: `light`, or `glow` where `is_light` is false, instead
/// of
///   what it reflects; with a texture only where that is not black.
/// * alpha: `mixfunc` or `mixpict` with what lies behind, by alpha times opacity (BLEND), or where
///   alpha is at least the cutoff (MASK).
/// Source: Khronos Group, glTF 2.0 Specification, ch. 3.9 and app. B; ray.pdf.
[[nodiscard]] std::string gltf_material_scene(const GltfMaterial& material,
                                              const GltfPictures& pictures, bool is_light);

/// A light, as scene text: point lights and spots are spheres of 1 cm (`light`, `spotlight`) of
/// that intensity, directional ones are sources of the sun's size of that illuminance.
[[nodiscard]] std::string gltf_light_scene(const GltfLight& light, const std::string& name);

}  // namespace lightwalk
