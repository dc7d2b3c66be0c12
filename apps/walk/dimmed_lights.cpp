#include "apps/walk/dimmed_lights.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "io/language/primitive_text.h"

namespace lightwalk {
LightMixture mixture_of(const LightsRequest& lights, const LightGroups& groups) {
    LightMixture mixture{std::vector<Rgb>(groups.size(), Rgb{1, 1, 1})};
    for (const LightLevel& light : lights.levels) {
        const auto found = std::ranges::find(groups.names, light.name);
        if (found == groups.names.end()) continue;
        mixture.levels[static_cast<std::size_t>(found - groups.names.begin())] =
            light.color * static_cast<float>(light.level);
    }
    // Nothing is dimmed: then pictures are those of a walk without dimmers, to the bit.
    if (std::ranges::all_of(mixture.levels, [](const Rgb& c) { return c == Rgb{1, 1, 1}; }))
        mixture.levels.clear();
    return mixture;
}

namespace {

/// The light that a modifier is, itself or as another name for it; null: it is none.
const Primitive* light_of(const std::vector<Primitive>& modifiers, const Primitive& modifier) {
    const bool alias = modifier.type == PrimitiveType::alias;
    if (alias && (modifier.references.empty() || modifier.references[0] < 0)) return nullptr;
    const Primitive& light =
        alias ? modifiers[static_cast<std::size_t>(modifier.references[0])] : modifier;
    return is_light(light.type) ? &light : nullptr;
}

}  // namespace

std::string scaled_lights(const std::vector<Primitive>& modifiers, const LightGroups& groups,
                          const LightMixture& mixture) {
    std::string text =
        "# Dimmed lights of a walk: in the scene's files these stand in place of the modifiers of\n"
        "# the same names. Lights in mixtures are not among them.\n";
    const std::size_t count = std::min(modifiers.size(), groups.of_modifier.size());
    for (std::size_t i = 0; i < count && !mixture.levels.empty(); ++i) {
        const Primitive* light = light_of(modifiers, modifiers[i]);
        const Rgb& level = mixture.levels[groups.of_modifier[i]];
        constexpr std::size_t kChannels = 3;
        if (light == nullptr || light->reals.size() < kChannels || level == Rgb{1, 1, 1}) continue;
        std::vector<double> reals = light->reals;
        for (std::size_t k = 0; k < kChannels; ++k) reals[k] *= static_cast<double>(level[k]);
        text += "\n# " + groups.names[groups.of_modifier[i]] + '\n';
        const bool plain = light->modifier < 0;
        append_primitive(plain ? "void" : modifiers[static_cast<std::size_t>(light->modifier)].name,
                         to_string(light->type), modifiers[i].name, light->strings, reals,
                         kFullDigits, text);
    }
    return text;
}

}  // namespace lightwalk
