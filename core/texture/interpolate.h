#pragma once
// Values of data tables and pictures between and beyond their points.
#include <span>

#include "core/model/resources.h"

namespace lightwalk {

/// Multilinear interpolation in a data table, first axis outermost.
/// @param table  axes of at least two points each
/// @param point  one coordinate an axis, in the order of the axes
/// Up to one interval beyond the table the value is extrapolated linearly, farther out it falls off
/// towards zero like 1/distance: continuously below the table, with a drop to one third above it,
/// as in Radiance. Double arithmetic; nothing is allocated or thrown, and a coordinate that is not
/// a number gives a result that is none. Source: Radiance's file format guide "ray.pdf", data
/// files.
[[nodiscard]] double interpolate(const DataArray& table, std::span<const double> point);

/// The same in a picture: u to the right, v up, pixel centres of the border on the ends of the
/// range.
[[nodiscard]] Rgb interpolate(const PictureData& picture, double u, double v);

}  // namespace lightwalk
