#pragma once
// Slices of long slanted cones, for the search tree: a branch's box is mostly air.
#include "core/geometry/bounds.h"
#include "core/geometry/shapes.h"

namespace lightwalk {

/// How a cone, cup, cylinder or tube is cut across its axis.
struct ConeSlices {
    int count = 1;    ///< of equal length; 1: left as it is
    double gain = 0;  ///< half the area that all boxes together lose [m²]
};

/// As many slices as are worth their boxes.
/// @param least  gain below which a cone is left as it is [m²]
[[nodiscard]] ConeSlices slices_of(const ConeShape& cone, double least);

/// Box of every point that `intersect` can report in a slice: all slices together hold what
/// `hit_bounds` holds.
/// @param i  0 at the smaller end
[[nodiscard]] Bounds hit_bounds(const ConeShape& cone, int i, int count);

}  // namespace lightwalk
