#pragma once
// Rendering options with rpict's defaults and names (see the manual page rpict(1)).
#include <cstdint>
#include <string>
#include <vector>

#include "core/ablation.h"
#include "core/math/rgb.h"

namespace lightwalk {

/// Which surfaces take part in the ambient calculation, by the names of their modifiers.
struct AmbientSelection {
    enum class Kind { all, include, exclude };
    Kind kind = Kind::all;
    std::vector<std::string> modifiers;
    friend bool operator==(const AmbientSelection&, const AmbientSelection&) = default;
};

/// All of them that are numbers: plain bytes, which processes can share.
struct RenderNumbers {
    // direct
    double shadow_threshold = 0.05;       ///< -dt
    double shadow_certainty = 0.5;        ///< -dc
    double source_jitter = 0;             ///< -dj
    double source_subdivision = 0.25;     ///< -ds
    int redirections = 1;                 ///< -dr
    double virtual_source_pretest = 512;  ///< -dp [samples/sr]
    bool sources_visible = true;          ///< -dv
    bool back_faces_visible = true;       ///< -bv
    // specular
    double specular_samples = 1;       ///< -ss
    double specular_threshold = 0.15;  ///< -st
    int reflection_limit = 7;          ///< -lr; <= 0: Russian roulette
    double weight_limit = 1e-4;        ///< -lw
    // medium
    Rgb extinction;           ///< -me [1/m]
    Rgb albedo;               ///< -ma
    double eccentricity = 0;  ///< -mg
    double scatter_step = 0;  ///< -ms [m]
    // ambient
    Rgb ambient_value;                ///< -av [W/(m² sr)]
    int ambient_weight = 0;           ///< -aw
    int ambient_bounces = 0;          ///< -ab
    double ambient_accuracy = 0.2;    ///< -aa
    int ambient_resolution = 64;      ///< -ar
    int ambient_divisions = 512;      ///< -ad
    int ambient_super_samples = 128;  ///< -as
    int ambient_lights = 2;           ///< --ambient-lights; 0: all
    int sample_lights = 0;            ///< of rays that are samples of a pixel; 0: all
    // irradiance
    bool irradiance = false;  ///< -i
    std::uint64_t seed = 0;   ///< --seed
    Ablation ablation;        ///< changes the speed only
    friend bool operator==(const RenderNumbers&, const RenderNumbers&) = default;
};

struct RenderOptions : RenderNumbers {
    AmbientSelection ambient_surfaces;  ///< -ae -ai -aE -aI
};

}  // namespace lightwalk
