#include "core/model/primitive.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {

bool is_sound_modifier(const Primitive& modifier, std::size_t number) {
    const auto earlier = static_cast<std::int64_t>(number);
    const auto names_one = [&](std::int32_t reference) {
        return reference >= kUndefinedIndex && reference < earlier;
    };
    return static_cast<std::size_t>(modifier.type) < primitive_type_count() &&
           !is_surface(modifier.type) && modifier.modifier >= kVoidIndex &&
           modifier.modifier < earlier && modifier.references.size() <= modifier.strings.size() &&
           std::ranges::all_of(modifier.references, names_one) &&
           std::ranges::all_of(modifier.reals, [](double x) { return std::isfinite(x); });
}

}  // namespace lightwalk
