#pragma once
// Coordinates for a search in single precision that loses no crossing: recentred, and with room for
// rounding.
#include <vector>

#include "core/geometry/placed_scene.h"

namespace lightwalk {

/// How the boxes of one model's primitives are handed to the search.
struct SearchSpace {
    Vec3 center;          ///< subtracted from all coordinates
    double margin = 0;    ///< that every box is grown by [m]
    double relative = 0;  ///< and this part of the box's largest coordinate

    /// The box in these coordinates.
    [[nodiscard]] Bounds box(Bounds bounds) const;
};

/// A space for each model. Boxes grow by what single precision loses for rays that start within
/// four times the region that holds nine tenths of the scene. Rays from farther away, or at far-off
/// surfaces, may miss an edge by a ten-millionth of the distance.
[[nodiscard]] std::vector<SearchSpace> search_spaces(const PlacedScene& scene);

}  // namespace lightwalk
