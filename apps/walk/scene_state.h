#pragma once
// What a walk has changed in its scene: the description it was read from, with other modifiers and
// sources.
#include <cstdint>
#include <map>

#include "core/model/model_change.h"

namespace lightwalk {

/// By default as the scene was read. Each is all that differs from that, not from the state before.
struct SceneState {
    /// Modifiers that are others now, by their indices in the model.
    std::map<std::int32_t, Primitive> replaced;
};

/// The change that turns a model into this state of it. Throws InputError for indices that the
/// model has not.
[[nodiscard]] ModelChange change_of(const Model& model, const SceneState& state);

}  // namespace lightwalk
