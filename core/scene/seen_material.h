#pragma once
// What the eye sees of surfaces: materials may stand for others.
#include <optional>

#include "core/scene/scene.h"

namespace lightwalk {

/// The material that a surface shows.
struct SeenMaterial {
    ModifierId first = kVoid;            ///< of the chain of modifiers that the eye sees
    std::optional<ModifierId> material;  ///< at its end; nothing: the surface is invisible
    MaterialTraits traits;               ///< of the material; absent where there is none
};

/// What is seen of a surface with a chain of modifiers, which may be kVoid: its own material, or
/// the alternate of one that the eye does not see (mirror, illum).
[[nodiscard]] SeenMaterial seen_material(const Scene& scene, ModifierId first);

}  // namespace lightwalk
