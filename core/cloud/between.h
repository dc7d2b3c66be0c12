#pragma once
// What a pixel sees between others that all see the same.
#include <span>

#include "core/cloud/sight.h"

namespace lightwalk {

/// Whether two pixels see the same thing: the same surfaces on the way, about as far away.
[[nodiscard]] bool see_alike(const PixelSights& a, const PixelSights& b);

/// What the middle of a pixel sees whose neighbours, in pairs on opposite sides, all see the same:
/// their mean. Exact for planes, but for the places in their pixels that the neighbours' rays go
/// through.
/// @param pairs  1 or 2 pairs
[[nodiscard]] PixelSights sights_between(std::span<const PixelSights* const> pairs,
                                         const PixelPlace& pixel);

}  // namespace lightwalk
