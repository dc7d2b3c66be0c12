#include "core/model/argument_names.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lightwalk {
namespace {

constexpr double kBrightest = 1e9;  // [W/(m² sr)]: the sun's disk is some 6e6
constexpr double kFarthestGlow = 1e6;
constexpr double kLeastAngle = 0.01;
constexpr double kLeastRoughness = 1e-4;  // of brushed materials, which cannot be smooth
constexpr double kLeastIndex = 0.2, kMostIndex = 5;
constexpr double kMostHartmann = 50;  // [nm]: with it the index is above 0 for all light
constexpr double kMostPower = 1e5;    // Ashikhmin's exponent
constexpr double kMostExtinction = 1e3;

using Names = std::vector<ArgumentName>;

void add_channels(Names& names, std::string_view quantity, double high = 1,
                  std::string_view unit = {}) {
    for (const std::string_view channel : {"red", "green", "blue"})
        names.push_back({quantity, channel, 0, high, unit});
}

Names reflecting(PrimitiveType type) {
    const bool brushed = type == PrimitiveType::plastic2 || type == PrimitiveType::metal2 ||
                         type == PrimitiveType::trans2;
    const bool passes = type == PrimitiveType::trans || type == PrimitiveType::trans2;
    Names names;
    add_channels(names, passes ? "colour" : "reflectance");
    names.push_back({"specularity", {}, 0, 1, {}});
    if (brushed) {
        names.push_back({"roughness along", {}, kLeastRoughness, 1, {}});
        names.push_back({"roughness across", {}, kLeastRoughness, 1, {}});
    } else {
        names.push_back({"roughness", {}, 0, 1, {}});
    }
    if (!passes) return names;
    names.push_back({"transmissivity", {}, 0, 1, {}});
    names.push_back({"transmitted specularity", {}, 0, 1, {}});
    return names;
}

Names emitting(PrimitiveType type) {
    Names names;
    add_channels(names, "radiance", kBrightest, "W/(m² sr)");
    if (type == PrimitiveType::glow)
        names.push_back({"reach of its light", {}, -kFarthestGlow, kFarthestGlow, "m"});
    if (type != PrimitiveType::spotlight) return names;
    names.push_back({"cone angle", {}, kLeastAngle, 360, "°"});
    for (const std::string_view axis : {"x", "y", "z"})
        names.push_back({"direction", axis, -kFarthestGlow, kFarthestGlow, {}});
    return names;
}

void add_index(Names& names, std::string_view quantity = "refractive index") {
    names.push_back({quantity, {}, kLeastIndex, kMostIndex, {}});
}

/// @param count  of the numbers that it has
Names refracting(PrimitiveType type, std::size_t count) {
    Names names;
    switch (type) {
        case PrimitiveType::glass:
            add_channels(names, "transmissivity");
            if (count > 3) add_index(names);
            break;
        case PrimitiveType::dielectric:
            add_channels(names, "transmission per unit length");
            add_index(names);
            names.push_back({"Hartmann constant", {}, -kMostHartmann, kMostHartmann, "nm"});
            break;
        default:
            add_channels(names, "transmission inside, per unit length");
            add_index(names, "refractive index inside");
            add_channels(names, "transmission outside, per unit length");
            add_index(names, "refractive index outside");
    }
    return names;
}

Names misty(std::size_t count) {
    constexpr double kForward = 0.999;
    Names names;
    if (count >= 3) add_channels(names, "extinction", kMostExtinction, "1/unit length");
    if (count >= 6) add_channels(names, "albedo");
    if (count >= 7) names.push_back({"eccentricity", {}, -kForward, kForward, {}});
    return names;
}

Names ashikhmin() {
    Names names;
    add_channels(names, "diffuse reflectance");
    add_channels(names, "specular reflectance");
    names.push_back({"exponent along", {}, 0, kMostPower, {}});
    names.push_back({"exponent across", {}, 0, kMostPower, {}});
    return names;
}

Names names_of(PrimitiveType type, std::size_t count) {
    switch (type) {
        case PrimitiveType::plastic:
        case PrimitiveType::metal:
        case PrimitiveType::trans:
        case PrimitiveType::plastic2:
        case PrimitiveType::metal2:
        case PrimitiveType::trans2:
            return reflecting(type);
        case PrimitiveType::light:
        case PrimitiveType::illum:
        case PrimitiveType::glow:
        case PrimitiveType::spotlight:
            return emitting(type);
        case PrimitiveType::glass:
        case PrimitiveType::dielectric:
        case PrimitiveType::interface:
            return refracting(type, count);
        case PrimitiveType::mirror: {
            Names names;
            add_channels(names, "reflectance");
            return names;
        }
        case PrimitiveType::mist:
            return misty(count);
        case PrimitiveType::ashik2:
            return ashikhmin();
        default:
            return {};
    }
}

std::string text_of(double value) {
    constexpr int kDigits = 6;
    char text[32];
    const auto end =
        std::to_chars(std::begin(text), std::end(text), value, std::chars_format::general, kDigits);
    return {text, end.ptr};
}

std::string words_of(const ArgumentName& name) {
    std::string words(name.quantity);
    if (!name.channel.empty()) words += " (" + std::string(name.channel) + ")";
    return words;
}

}  // namespace

std::vector<ArgumentName> argument_names(const Primitive& primitive) {
    Names names = names_of(primitive.type, primitive.reals.size());
    if (names.size() != primitive.reals.size()) names.clear();
    return names;
}

std::optional<std::string> argument_problem(const Primitive& primitive,
                                            std::span<const double> reals) {
    const std::string type(to_string(primitive.type));
    const Names names = argument_names(primitive);
    if (names.empty()) return "the numbers of a " + type + " cannot be changed here";
    if (reals.size() != names.size())
        return "a " + type + " has " + std::to_string(names.size()) + " numbers, not " +
               std::to_string(reals.size());
    for (std::size_t i = 0; i < reals.size(); ++i) {
        const ArgumentName& name = names[i];
        if (!std::isfinite(reals[i])) return words_of(name) + " must be a number";
        const bool sensible = reals[i] >= name.low && reals[i] <= name.high;
        if (sensible || reals[i] == primitive.reals[i]) continue;
        std::string problem =
            words_of(name) + " must be from " + text_of(name.low) + " to " + text_of(name.high);
        if (!name.unit.empty()) problem += ' ' + std::string(name.unit);
        return problem;
    }
    constexpr std::size_t kDirection = 4;  // of a spotlight
    if (primitive.type == PrimitiveType::spotlight &&
        std::ranges::all_of(reals.subspan(kDirection), [](double x) { return x == 0; }))
        return "direction must not be 0 0 0";
    return std::nullopt;
}

}  // namespace lightwalk
