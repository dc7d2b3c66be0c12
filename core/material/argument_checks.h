#pragma once
// Checks of the arguments that a scene file gives to a material.
#include <cstddef>

#include "core/math/rgb.h"
#include "core/model/primitive.h"
#include "core/scene/modifier.h"

namespace lightwalk {

/// Throws InputError `bad number of arguments for TYPE "NAME": N expected, M given` unless the
/// primitive has exactly `count` real arguments.
void require_exact_reals(const Primitive& primitive, std::size_t count);
/// Throws InputError unless the primitive has at least `count` real arguments.
void require_least_reals(const Primitive& primitive, std::size_t count);
/// Throws InputError unless the primitive has at least `count` string arguments.
void require_least_strings(const Primitive& primitive, std::size_t count);
/// Throws InputError unless the primitive has at most `count` string arguments.
void require_most_strings(const Primitive& primitive, std::size_t count);

/// Throws InputError unless `index`, an index of refraction, is a positive number.
void require_index(const Primitive& primitive, double index);

/// What an illum or a mirror shows instead of itself: its first string argument; void where that is
/// missing, or where nothing has that name, which is a warning.
[[nodiscard]] ModifierId alternate_of(const ModifierBuild& build);

/// The real arguments number first, first + 1 and first + 2 as a colour.
[[nodiscard]] inline Rgb color_argument(const Primitive& primitive, std::size_t first = 0) {
    return {static_cast<float>(primitive.reals[first]),
            static_cast<float>(primitive.reals[first + 1]),
            static_cast<float>(primitive.reals[first + 2])};
}

}  // namespace lightwalk
