#include "apps/walk/scene_state.h"

#include "core/error.h"

namespace lightwalk {

ModelChange SceneStates::change_of(const SceneState& state) const {
    ModelChange change = read_;
    if (state.time) {
        if (skies_.empty()) throw InputError("no generator writes the scene's sky");
        if (!skies_.refusal().empty()) throw InputError(skies_.refusal());
        skies_.apply(*state.time, change);
    }
    for (const auto& [index, primitive] : state.replaced) {
        if (index < 0 || static_cast<std::size_t>(index) >= own_modifiers_)
            throw InputError(primitive.where, "there is no such modifier to be replaced");
        change.modifiers[static_cast<std::size_t>(index)] = primitive;
    }
    return change;
}

}  // namespace lightwalk
