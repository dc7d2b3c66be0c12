#include "core/model/model_change.h"

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
