#pragma once
// An order of points that only the points themselves decide: not where they are kept, nor by whom.
#include <cstdint>

#include "core/cloud/point.h"

namespace lightwalk {

/// A total order by content: neither of two points precedes the other only where they are the same.
[[nodiscard]] bool precedes(const CloudPoint& a, const CloudPoint& b);

/// Evenly distributed, another one for each frame: for choices among points that are as good as
/// each other.
[[nodiscard]] std::uint32_t lot(const CloudPoint& point, std::uint64_t frame);

}  // namespace lightwalk
