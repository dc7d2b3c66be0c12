#include "core/scene/seen_material.h"

namespace lightwalk {
namespace {

constexpr int kMostAlternates = 8;  // length of a chain of alternate materials

}  // namespace

SeenMaterial seen_material(const Scene& scene, ModifierId first) {
    SeenMaterial seen{first, scene.material_of(first), {}};
    for (int i = 0; i < kMostAlternates && seen.material; ++i) {
        const auto& node = scene.modifier(*seen.material).node;
        if (!node) return {first, seen.material, {}};
        seen.traits = node->traits();
        if (seen.traits.appearance != Appearance::another) break;
        seen.first = seen.traits.seen;
        seen.material = scene.material_of(seen.first);
    }
    if (!seen.material) seen.traits = {.appearance = Appearance::absent};
    return seen;
}

}  // namespace lightwalk
