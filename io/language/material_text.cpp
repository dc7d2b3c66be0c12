#include "io/language/material_text.h"

#include <array>
#include <cmath>

namespace lightwalk {
namespace {

/// A coordinate of a picture, from 0 to 1, as it goes on, times `ratio`.
std::string coordinate_text(const std::string& coordinate, TextureWrap wrap, double ratio) {
    std::string text = "frac(" + coordinate + ")";
    if (wrap == TextureWrap::mirror) {
        const std::string half = "frac(" + coordinate + "/2)";
        text = "(1-2*abs(" + half + "-.5))";
    } else if (wrap == TextureWrap::clamp) {
        text = "if(" + coordinate + ",if(1-" + coordinate + "," + coordinate + ",1),0)";
    }
    return ratio > 1 ? text + "*" + std::to_string(ratio) : text;
}

/// u and v of a picture, whose shorter side is 1.
std::array<std::string, 2> coordinates_text(const TexturePicture& picture) {
    return {coordinate_text("Lu", picture.wrap_u, picture.aspect),
            coordinate_text("Lv", picture.wrap_v, 1 / picture.aspect)};
}

}  // namespace

void MaterialText::add_map(const std::string& name, const TexturePicture& picture) {
    const auto [u, v] = coordinates_text(picture);
    add("void", "colorpict", name, {"red", "green", "blue", picture.file, ".", u, v}, {});
}

void MaterialText::add_mix(const std::string& name, const std::string& fore,
                           const std::string& back, const std::string& function,
                           const std::string& library, const TexturePicture& picture,
                           const std::vector<double>& reals) {
    const auto [u, v] = coordinates_text(picture);
    add("void", "mixpict", name, {fore, back, function, picture.file, library, u, v}, reals);
}

void MaterialText::add_veil(const std::string& name, const std::string& material, double opacity) {
    add("void", "mixfunc", name, {material, "void", std::to_string(opacity), "."}, {});
}

double transmissivity(double t) {
    if (t < 1e-4) return 0;
    return (std::sqrt(0.8402528435 + 0.0072522239 * t * t) - 0.9166530661) / 0.0036261119 / t;
}

}  // namespace lightwalk
