#pragma once
// An order of points by their contents, independent of where and by which rank they are stored:
// choices by it are deterministic.
#include <cstdint>

#include "core/cloud/point.h"

namespace lightwalk {

/// A total order by content: neither of two points precedes the other only where they are the same.
[[nodiscard]] bool precedes(const CloudPoint& a, const CloudPoint& b);

/// A hash of a point and the number of a frame, uniformly distributed: for random but deterministic
/// choices among points.
[[nodiscard]] std::uint32_t lot(const CloudPoint& point, std::uint64_t frame);

}  // namespace lightwalk
