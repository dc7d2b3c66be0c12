#pragma once
// Which function makes the modifiers of which type: textures, patterns, mixtures and materials, as
// core/model/primitive_types.def lists them. A Scene is given this function when it is built.
#include "core/scene/modifier.h"

namespace lightwalk {

/// The factory for modifiers of a type; null for surfaces and aliases.
[[nodiscard]] ModifierFactory modifier_factory(PrimitiveType type);

}  // namespace lightwalk
