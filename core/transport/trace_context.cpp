#include "core/transport/trace_context.h"

#include <algorithm>

namespace lightwalk {

bool ScatterList::contains(std::int32_t source) const {
    return std::find(sources.begin(), sources.end(), source) != sources.end();
}

bool ClipSet::contains(ModifierId m) const {
    return std::binary_search(modifiers.begin(), modifiers.end(), m);
}

}  // namespace lightwalk
