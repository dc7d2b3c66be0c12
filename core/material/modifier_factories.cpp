#include "core/material/modifier_factories.h"

namespace lightwalk {

// Defined where the modifier is; throws InputError for bad arguments.
#define MODIFIER(id, word, kind, factory) \
    std::unique_ptr<const Modifier> factory(const ModifierBuild& build);
#include "core/model/primitive_types.def"

ModifierFactory modifier_factory(PrimitiveType type) {
    switch (type) {
#define MODIFIER(id, word, kind, factory) \
    case PrimitiveType::id:               \
        return factory;
#include "core/model/primitive_types.def"
        default:
            return nullptr;
    }
}

}  // namespace lightwalk
