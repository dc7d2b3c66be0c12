#include "core/model/model_change.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace lightwalk {

Primitive to_primitive(const SurfacePrimitive& surface) {
    Primitive primitive;
    primitive.type = surface.type;
    primitive.modifier = surface.modifier;
    primitive.name = std::string(surface.name);
    primitive.strings = surface.strings.to_strings();
    for (std::size_t i = 0; i < surface.reals.size(); ++i)
        primitive.reals.push_back(surface.reals[i]);
    primitive.where = surface.where();
    return primitive;
}

ModelChange unchanged(const Model& model) {
    ModelChange change{model.modifiers, {}};
    std::size_t others = 0;
    for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
        if (model.surfaces.type(i) == PrimitiveType::source)
            change.sources.push_back({others, to_primitive(model.surfaces[i])});
        else
            ++others;
    }
    return change;
}

void check_sound(const ModelChange& change, const Model& model) {
    bool sound = true;
    for (std::size_t i = 0; i < change.modifiers.size(); ++i)
        sound = sound && is_sound_modifier(change.modifiers[i], i);
    const auto modifiers = static_cast<std::int64_t>(change.modifiers.size());
    for (const PlacedSource& placed : change.sources) {
        const Primitive& source = placed.source;
        sound = sound && source.type == PrimitiveType::source && source.modifier >= kVoidIndex &&
                source.modifier < modifiers && placed.before <= model.surfaces.size() &&
                std::ranges::all_of(source.reals, [](double x) { return std::isfinite(x); });
    }
    if (!sound) throw InputError("a change of the scene has modifiers or sources that cannot be");
}

std::shared_ptr<Model> changed_model(const Model& model, const ModelChange& change) {
    auto changed = std::make_shared<Model>();
    changed->modifiers = change.modifiers;
    for (std::size_t i = changed->modifiers.size(); i < model.modifiers.size(); ++i)
        changed->modifiers.push_back(model.modifiers[i]);
    changed->header = model.header;
    changed->cube = model.cube;
    std::size_t others = 0;
    auto next = change.sources.begin();
    const auto add_sources = [&] {
        for (; next != change.sources.end() && next->before <= others; ++next)
            changed->surfaces.add(next->source);
    };
    for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
        if (model.surfaces.type(i) == PrimitiveType::source) continue;
        add_sources();
        changed->surfaces.add(model.surfaces[i]);
        ++others;
    }
    for (; next != change.sources.end(); ++next) changed->surfaces.add(next->source);
    changed->surfaces.trim();
    return changed;
}

}  // namespace lightwalk
