#pragma once
// Coordinates for a search in single precision that loses no crossing: recentred, and with boxes
// grown by a margin for rounding.
#include <vector>

#include "core/geometry/placed_scene.h"

namespace lightwalk {

/// How the boxes of one model's primitives are handed to the search.
struct SearchSpace {
    Vec3 center;          ///< subtracted from all coordinates
    double margin = 0;    ///< by which every box is grown [m]
    double relative = 0;  ///< and by this share of the largest coordinate of the box

    /// A box of the model in the search coordinates, grown by the margins.
    [[nodiscard]] Bounds box(Bounds bounds) const;
};

/// The search space of each model. Boxes grow by the rounding error of single precision for rays
/// that start within four times the region that holds nine tenths of the scene. Rays from farther
/// away, or at far-off surfaces, may miss an edge by a ten-millionth of the distance.
[[nodiscard]] std::vector<SearchSpace> search_spaces(const PlacedScene& scene);

}  // namespace lightwalk
