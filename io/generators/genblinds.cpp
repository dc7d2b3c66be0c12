// genblinds: venetian blinds with flat or curved slats. See Radiance's manual page genblinds(1).
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGenblindsUsage =
    "material name depth width height slats angle [-r radius | +r radius]";
constexpr double kPieceAngle = 3 * kPi / 180;  ///< arc angle of one polygon of a curved slat [rad]

struct Blinds {
    std::string material, name;
    double depth = 0, width = 0, height = 0;
    long slats = 0;
    double angle = 0;     ///< angle of the slats above the horizontal [rad]
    double radius = 0;    ///< radius of curved slats; 0 for flat ones
    bool arched = false;  ///< upward; else sagging
};

Blinds parse_genblinds(GeneratorWords& words) {
    Blinds blinds;
    blinds.material = words.text("material");
    blinds.name = words.text("name");
    blinds.depth = words.real("depth");
    blinds.width = words.real("width");
    blinds.height = words.real("height");
    blinds.slats = words.integer("number of slats", 1, static_cast<long>(kMaxPieces));
    blinds.angle = words.real("angle") * kPi / 180;
    if (!words.at_end()) {
        blinds.arched = words.accept("+r");
        if (!blinds.arched && !words.accept("-r")) words.unknown_option();
        const double radius = words.real("radius");
        if (radius < 0) blinds.arched = !blinds.arched;
        blinds.radius = std::abs(radius);
    }
    if (!words.at_end()) words.unknown_option();
    if (blinds.radius > 0 && !(std::abs(blinds.depth) <= 2 * blinds.radius)) {
        words.fail(
            "a slat of this depth does not fit the radius, expected at least half the depth");
    }
    return blinds;
}

/// The profile of one slat: x and z of its pieces' ends.
std::vector<std::array<double, 2>> slat_profile(const Blinds& blinds) {
    const double r = blinds.radius;
    if (r == 0) {
        return {{0, 0},
                {blinds.depth * std::cos(blinds.angle), blinds.depth * std::sin(blinds.angle)}};
    }
    const double arc = 2 * std::asin(blinds.depth / (2 * r));
    const int pieces = std::max(1, static_cast<int>(std::floor(arc / kPieceAngle + 0.99999)));
    const double step = arc / pieces;
    const double begin = (kPi - arc) / 2 - blinds.angle;
    std::vector<std::array<double, 2>> profile;
    for (int k = 0; k <= pieces; ++k) {
        if (blinds.arched) {
            const double at = begin + k * step;
            profile.push_back(
                {r * (std::cos(begin) - std::cos(at)), r * (std::sin(at) - std::sin(begin))});
        } else {
            const double end = begin + arc;
            const double at = end - k * step;
            profile.push_back(
                {r * (std::cos(at) - std::cos(end)), r * (std::sin(end) - std::sin(at))});
        }
    }
    return profile;
}

}  // namespace

std::string run_genblinds(std::span<const std::string> args, GeneratorContext& context) {
    static_cast<void>(context);
    GeneratorWords words(args, kGenblindsUsage);
    const Blinds blinds = parse_genblinds(words);
    const auto profile = slat_profile(blinds);
    if (static_cast<std::size_t>(blinds.slats) * (profile.size() - 1) > kMaxPieces) {
        words.fail("too many slats, expected at most " + std::to_string(kMaxPieces) + " polygons");
    }
    SceneWriter out(args);
    for (long i = 1; i <= blinds.slats; ++i) {
        const double lift =
            blinds.height * (static_cast<double>(i) - 0.5) / static_cast<double>(blinds.slats);
        for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
            const auto& a = profile[k];
            const auto& b = profile[k + 1];
            const std::array<Vec3, 4> corners = {{{a[0], 0, a[1] + lift},
                                                  {a[0], blinds.width, a[1] + lift},
                                                  {b[0], blinds.width, b[1] + lift},
                                                  {b[0], 0, b[1] + lift}}};
            out.polygon(blinds.material,
                        blinds.name + "." + std::to_string(i) + "." + std::to_string(k), corners);
        }
    }
    return out.release();
}

}  // namespace lightwalk
