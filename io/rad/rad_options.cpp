#include "io/rad/rad_options.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

namespace lightwalk {
namespace {

using Words = std::vector<std::string>;

/// What depends on QUALITY= alone.
struct QualityRow {
    const char *threshold, *shadow_threshold, *certainty, *redirections, *specular_samples,
        *specular_threshold, *reflections, *weight;
    const char* subdivision[2];  ///< without and with penumbras
    int enlarged;                ///< sides of the picture that is filtered
};
// Source: what `rad -n` of Radiance 6.1 prints.
constexpr std::array<QualityRow, 3> kQuality{
    {{".16", ".1", ".5", "0", "0", ".5", "6", ".001", {"0", ".4"}, 1},
     {".08", ".07", ".7", "1", "1", ".1", "8", "1e-4", {".3", ".2"}, 2},
     {".04", ".04", ".9", "3", "16", ".01", "12", "5e-6", {".2", ".1"}, 3}}};

/// By QUALITY=, then DETAIL=.
using ByDetail = std::array<std::array<int, 3>, 3>;
constexpr ByDetail kSpacing{{{16, 8, 4}, {8, 6, 4}, {8, 5, 3}}};
constexpr ByDetail kSpacingOfPenumbras{{{16, 8, 4}, {4, 3, 2}, {1, 1, 1}}};
constexpr ByDetail kPretest{{{64, 128, 256}, {256, 512, 1024}, {1024, 2048, 4096}}};
constexpr ByDetail kResolution{{{8, 16, 32}, {16, 32, 64}, {32, 64, 128}}};
constexpr ByDetail kSteps{{{0, 0, 0}, {20, 40, 80}, {40, 80, 160}}};  ///< of mist, in the zone

struct AmbientRow {
    const char *accuracy, *divisions, *super_samples;
};
/// By VARIABILITY=, then QUALITY=.
constexpr std::array<std::array<AmbientRow, 3>, 3> kAmbient{
    {{{{".3", "256", "0"}, {".2", "329", "42"}, {".125", "512", "64"}}},
     {{{".25", "512", "0"}, {".15", "800", "128"}, {".1", "1536", "768"}}},
     {{{".2", "1024", "0"}, {".1", "1536", "392"}, {".075", "4096", "2048"}}}}};

std::size_t at(RadLevel level) {
    return static_cast<std::size_t>(level);
}
int of(const ByDetail& table, const RadPlan& plan) {
    return table[at(plan.quality)][at(plan.detail)];
}

/// As rad writes it: to two digits.
std::string rough_number(double x) {
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%.2g", x);
    return text.data();
}

/// Middle grey for the exposure, or what is usual out of doors and within.
std::string ambient_value(const RadPlan& plan) {
    constexpr double kGrey = 0.18, kOutside = 10, kInside = 0.01;
    if (plan.exposure) return rough_number(kGrey / *plan.exposure);
    return rough_number(!plan.zone || plan.zone->exterior ? kOutside : kInside);
}

int bounces(const RadPlan& plan) {
    if (plan.quality == RadLevel::low) return 0;
    return plan.indirect + (plan.quality == RadLevel::high ? 1 : 0);
}

}  // namespace

std::vector<std::string> rad_light_words(const RadPlan& plan) {
    const QualityRow& quality = kQuality[at(plan.quality)];
    const AmbientRow& ambient = kAmbient[at(plan.variability)][at(plan.quality)];
    Words words{"-dp", std::to_string(of(kPretest, plan)), "-ds",
                quality.subdivision[plan.penumbras ? 1 : 0]};
    const auto add = [&](const Words& more) {
        words.insert(words.end(), more.begin(), more.end());
    };
    if (plan.penumbras && plan.quality != RadLevel::low) add({"-dj", ".9"});
    add({"-dt", quality.shadow_threshold, "-dc", quality.certainty, "-dr", quality.redirections});
    add({"-ss", quality.specular_samples, "-st", quality.specular_threshold});
    if (bounces(plan) != 0) add({"-ab", std::to_string(bounces(plan))});
    if (!plan.ambient_file.empty()) add({"-af", plan.ambient_file});
    add({"-aa", ambient.accuracy, "-ad", ambient.divisions, "-as", ambient.super_samples});
    const std::string grey = ambient_value(plan);
    add({"-av", grey, grey, grey, "-lr", quality.reflections, "-lw", quality.weight});
    return words;
}

std::vector<std::string> rad_pixel_words(const RadPlan& plan) {
    return {"-ps", std::to_string(of(plan.penumbras ? kSpacingOfPenumbras : kSpacing, plan)), "-pt",
            kQuality[at(plan.quality)].threshold};
}

std::vector<std::string> rad_size_words(const RadPlan& plan) {
    Words words{"-x", std::to_string(plan.width), "-y", std::to_string(plan.height)};
    if (plan.pixel_aspect) words.insert(words.end(), {"-pa", std::to_string(*plan.pixel_aspect)});
    return words;
}

int rad_ambient_resolution(const RadPlan& plan, const RadZone& zone, double edge) {
    constexpr double kMost = 1 << 30;
    return static_cast<int>(std::min(of(kResolution, plan) * (edge / zone.mean_edge()), kMost));
}

double rad_scatter_step(const RadPlan& plan, const RadZone& zone) {
    const int steps = of(kSteps, plan);
    return steps == 0 ? 0 : std::strtod(rough_number(zone.mean_edge() / steps).c_str(), nullptr);
}

int rad_samples(const RadPlan& plan) {
    const int side = kQuality[at(plan.quality)].enlarged;
    return side * side;
}

}  // namespace lightwalk
