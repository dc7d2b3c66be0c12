#pragma once
// Checks of the arguments of materials, and colours among them.
#include <cstddef>

#include "core/math/rgb.h"
#include "core/model/primitive.h"

namespace lightwalk {

/// Throws `bad number of arguments for TYPE "NAME": N expected, M given` unless there are exactly
/// `count` reals.
void require_exact_reals(const Primitive& primitive, std::size_t count);
/// The same for "at least N".
void require_least_reals(const Primitive& primitive, std::size_t count);
/// The same for string arguments.
void require_least_strings(const Primitive& primitive, std::size_t count);
/// The same for "at most N".
void require_most_strings(const Primitive& primitive, std::size_t count);

/// Throws unless an index of refraction is a positive number.
void require_index(const Primitive& primitive, double index);

/// Real arguments first, first + 1, first + 2 as a colour.
[[nodiscard]] inline Rgb color_argument(const Primitive& primitive, std::size_t first = 0) {
    return {static_cast<float>(primitive.reals[first]),
            static_cast<float>(primitive.reals[first + 1]),
            static_cast<float>(primitive.reals[first + 2])};
}

}  // namespace lightwalk
