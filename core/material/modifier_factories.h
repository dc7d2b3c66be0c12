#pragma once
// Who compiles which modifier: the textures, patterns, mixtures and materials of
// core/model/primitive_types.def, handed to a Scene.
#include "core/scene/modifier.h"

namespace lightwalk {

/// The factory for a type; null for surfaces, aliases, and types that are recognised and refused
/// (WGMDfunc, BSDF, aBSDF, spectra).
[[nodiscard]] ModifierFactory modifier_factory(PrimitiveType type);

}  // namespace lightwalk
