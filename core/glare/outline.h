#pragma once
// Outlines of sets of pixels, as polygons of directions that any view can draw.
#include <cstddef>
#include <span>
#include <vector>

#include "core/view/pixels.h"
#include "core/view/view.h"

namespace lightwalk {

/// The outer outline of some pixels, counterclockwise as the eye sees it, as a closed polygon:
/// consecutive points, and the last and the first, are joined by arcs of great circles. Where the
/// outline has straight edges, its points are their corners, whatever the view. Pixels that do not
/// touch get one outline: all are widened by the same number of pixels to all sides, the smallest
/// that connects them. Holes have no outline.
/// @param places  distinct, inside the picture
/// @param camera  of a visual_field() of width x height pixels
/// @param limit   largest number of points, at least 4
/// @return        4 to `limit` unit vectors, within two pixels of the pixels' edges, farther
///                where that takes more points; nothing for no pixels
[[nodiscard]] std::vector<Vec3> outline_of(std::span<const PixelPlace> places, const Camera& camera,
                                           int width, int height, std::size_t limit = 64);

/// A point in an image: h to the right, v up, the picture being from 0 to 1.
struct OutlinePoint {
    double h = 0, v = 0;
};

/// A closed polygon of directions as a view shows it, in order, outside the picture, too. In a
/// perspective its edges are straight, and what is beside or behind the eye is cut off; in the
/// other views an edge is drawn as points at most 5 degrees apart, and in a hemispherical one, too,
/// what is behind the eye is cut off. A parallel view shows no directions: nothing.
[[nodiscard]] std::vector<OutlinePoint> project_outline(std::span<const Vec3> outline,
                                                        const Camera& camera);

}  // namespace lightwalk
