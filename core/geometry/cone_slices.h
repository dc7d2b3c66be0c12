#pragma once
// Slices of long slanted cones for the search tree: the box of a whole slanted branch would be
// mostly empty.
#include "core/geometry/bounds.h"
#include "core/geometry/shapes.h"

namespace lightwalk {

/// How a cone, cup, cylinder or tube is cut across its axis.
struct ConeSlices {
    int count = 1;    ///< slices of equal length; 1: the cone is not cut
    double gain = 0;  ///< by how much half the surface area of the boxes shrinks [m²]
};

/// The number of slices for which the smaller boxes outweigh their number.
/// @param least  gain below which a cone is left as it is [m²]
[[nodiscard]] ConeSlices slices_of(const ConeShape& cone, double least);

/// Box of every point that `intersect` can report in a slice: all slices together hold what
/// `hit_bounds` holds.
/// @param i  0 at the smaller end
[[nodiscard]] Bounds hit_bounds(const ConeShape& cone, int i, int count);

}  // namespace lightwalk
