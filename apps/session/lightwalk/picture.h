#pragma once
// What a renderer makes: pictures and answers to rays. Part of the public interface.
#include <cstdint>
#include <string>
#include <vector>

#include "core/math/rgb.h"

namespace lightwalk {

/// What a group of emitters adds to a picture.
struct RenderedLayer {
    std::string name;
    std::vector<Rgb> radiance;  ///< as the picture's [W/(m² sr)]
};

/// A picture of radiance, rows from the top, left to right.
struct RenderedPicture {
    int width = 0, height = 0;          ///< [pixels]
    std::vector<Rgb> radiance;          ///< width * height [W/(m² sr)]
    std::vector<float> distance;        ///< along the pixels' rays; 1e10: nothing, 0: no ray [m]
    std::uint64_t rays = 0;             ///< of all kinds that were traced for it, by this process
    std::vector<float> error;           ///< with a SampleGoal: of pixels' luminance, relative
    std::vector<Rgb> half;              ///< with a SampleGoal: radiance by half of the samples
    std::vector<RenderedLayer> layers;  ///< with light groups: they add up to the radiance
};

/// Write by extension: .hdr .pic (Radiance), .exr, .png, .jpg (exposed automatically, sRGB). The
/// file appears whole or not at all. Throws InputError, which names the file.
/// @param header  lines for the header of formats that have one: "VIEW= ...", a program's name
void save_picture(const std::string& path, const RenderedPicture& picture,
                  const std::vector<std::string>& header = {});

/// What a ray brings back.
struct RayResult {
    Rgb radiance;         ///< [W/(m² sr)], or irradiance where that was asked for [W/m²]
    double distance = 0;  ///< to what it meets first; 1e10: nothing [m]
};

}  // namespace lightwalk
