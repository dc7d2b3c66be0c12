#include "core/scene/primitive.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lightwalk {
namespace {

constexpr std::size_t kTypeCount = static_cast<std::size_t>(PrimitiveType::alias) + 1;

/// The words of the scene language, in the order of PrimitiveType.
constexpr std::array<std::string_view, kTypeCount> kTypeNames = {
    // surfaces
    "source", "sphere", "bubble", "polygon", "cone", "cup", "cylinder", "tube", "ring", "instance",
    "mesh",
    // materials
    "light", "illum", "glow", "spotlight", "mirror", "prism1", "prism2", "mist", "plastic", "metal",
    "trans", "plastic2", "metal2", "trans2", "ashik2", "WGMDfunc", "dielectric", "interface",
    "glass", "plasfunc", "metfunc", "transfunc", "BRTDfunc", "plasdata", "metdata", "transdata",
    "BSDF", "aBSDF", "antimatter",
    // textures, patterns, mixtures, spectra
    "texfunc", "texdata", "brightfunc", "colorfunc", "brightdata", "colordata", "colorpict",
    "brighttext", "colortext", "mixfunc", "mixdata", "mixpict", "mixtext", "spectrum", "specfile",
    "specfunc", "specdata", "specpict", "alias"};

}  // namespace

std::string_view to_string(PrimitiveType type) {
    return kTypeNames[static_cast<std::size_t>(type)];
}

std::optional<PrimitiveType> primitive_type(std::string_view word) {
    const auto found = std::find(kTypeNames.begin(), kTypeNames.end(), word);
    if (found == kTypeNames.end()) return std::nullopt;
    return static_cast<PrimitiveType>(found - kTypeNames.begin());
}

bool is_surface(PrimitiveType type) {
    return type <= PrimitiveType::mesh;
}

bool is_material(PrimitiveType type) {
    return type >= PrimitiveType::light && type <= PrimitiveType::antimatter;
}

bool is_mixture(PrimitiveType type) {
    return type >= PrimitiveType::mixfunc && type <= PrimitiveType::mixtext;
}

}  // namespace lightwalk
