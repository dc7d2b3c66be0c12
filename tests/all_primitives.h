#pragma once
// The contents of a model as a list of primitives.
#include <string>
#include <vector>

#include "core/model/model_change.h"
#include "core/model/primitive.h"

namespace lightwalk::test {

/// A SurfacePrimitive that refers to a primitive, which must outlive it.
[[nodiscard]] inline SurfacePrimitive view_of(const Primitive& primitive) {
    return {primitive.type,  primitive.modifier,    primitive.name,      {},
            primitive.reals, &primitive.where.file, primitive.where.line};
}

/// The surfaces of a model, in their order.
[[nodiscard]] inline std::vector<Primitive> surfaces_of(const Model& model) {
    std::vector<Primitive> all;
    for (std::size_t i = 0; i < model.surfaces.size(); ++i)
        all.push_back(to_primitive(model.surfaces[i]));
    return all;
}

/// The modifiers of a model, in their order, then its surfaces.
[[nodiscard]] inline std::vector<Primitive> all_primitives(const Model& model) {
    std::vector<Primitive> all = model.modifiers;
    for (Primitive& surface : surfaces_of(model)) all.push_back(std::move(surface));
    return all;
}

}  // namespace lightwalk::test
