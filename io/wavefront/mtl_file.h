#pragma once
// Wavefront material files (.mtl), and the Radiance materials that stand for them.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/language/material_text.h"

namespace lightwalk {

struct MtlMaterial {
    std::string name;
    std::array<double, 3> kd{0.8, 0.8, 0.8};  ///< diffuse reflectance
    std::array<double, 3> ks{}, ke{};         ///< specular reflectance; emitted radiance
    std::array<double, 3> tf{1, 1, 1};        ///< colour of what is let through
    double ns = 0;                            ///< exponent of the highlight
    double d = 1;                             ///< opacity: 0 is not there
    double ni = 1;                            ///< refractive index
    std::optional<int> illum;                 ///< model of illumination, from 0 to 10
    std::string map_kd;                       ///< picture of the diffuse reflectance
    std::string map_d;                        ///< picture of the opacity
    bool bumpy = false;                       ///< has a map of heights or normals
};

/// The pictures of a material that are there.
struct MtlPictures {
    std::optional<TexturePicture> diffuse;
    std::optional<TexturePicture> opacity;  ///< of which the red channel counts
};

/// Decode a file. Statements that do not matter here are skipped. Throws InputError "NAME:LINE:
/// ...". Source: D. Ramey, L. Rose, L. Tyerman, "MTL material format", Alias/Wavefront (1995).
[[nodiscard]] std::vector<MtlMaterial> decode_mtl(std::string_view text, const std::string& name);

/// A material, as scene text:
/// * Ke: `glow` of that radiance, which lights by indirect light only, as a mesh is no light
/// source.
/// * illum 4, 6, 7 or 9 (glass, refraction), d below 1: `glass` that lets (1 - d) Tf through at
///   right angles, of index Ni.
/// * Else reflection: Kd diffuse; Ks (but for illum 0 and 1) specular, grey as `plastic`, coloured
///   as `metal`; its roughness is sqrt(2 / (Ns + 2)), by which Beckmann's distribution resembles
///   the power of a cosine (Walter et al., "Microfacet models for refraction through rough
///   surfaces", EGSR 2007, sec. 5.2). What reflects more than all is scaled down.
/// * d below 1 without glass: `mixfunc` of the material and what lies behind.
/// * map_d without glass: `mixpict` of the two by the picture's alpha, or its values where it has
/// none, times d.
/// * map_Kd: `colorpict` that multiplies Kd by the picture at the mesh's coordinates, repeating.
[[nodiscard]] std::string mtl_scene(const MtlMaterial& material, const MtlPictures& pictures);

}  // namespace lightwalk
