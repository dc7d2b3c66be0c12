#include "apps/walk/scene_state.h"

#include "core/error.h"

namespace lightwalk {

ModelChange change_of(const Model& model, const SceneState& state) {
    ModelChange change = unchanged(model);
    for (const auto& [index, primitive] : state.replaced) {
        if (index < 0 || static_cast<std::size_t>(index) >= model.modifiers.size())
            throw InputError(primitive.where, "there is no such modifier to be replaced");
        change.modifiers[static_cast<std::size_t>(index)] = primitive;
    }
    return change;
}

}  // namespace lightwalk
