#pragma once
// Clustering of directions.
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec3.h"

namespace lightwalk {

/// Groups of directions in which one reaches from each member to each other by steps of at most
/// `angle` (single linkage).
/// @param directions  unit vectors
/// @param angle       [rad], from 0 to π / 2
/// @return            for each direction its group; groups count from 0 in the order of their first
///                    members
/// Time: n log n for directions that lie as those of a picture's pixels do, n² at worst.
[[nodiscard]] std::vector<std::uint32_t> group_directions(std::span<const Vec3> directions,
                                                          double angle);

}  // namespace lightwalk
