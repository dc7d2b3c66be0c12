#pragma once
// Interpolation and extrapolation in data tables and pictures.
#include <span>

#include "core/model/resources.h"

namespace lightwalk {

/// Multilinear interpolation in a data table, first axis outermost.
/// @param table  axes of at least two points each
/// @param point  one coordinate for each axis, in the order of the axes
/// Up to one interval beyond the table the value is extrapolated linearly, farther out it falls off
/// towards zero like 1/distance: continuously below the table, with a drop to one third above it,
/// as in Radiance. Double arithmetic; nothing is allocated or thrown, and NaN coordinates give NaN.
/// Source: Radiance's file format guide "ray.pdf", data files.
[[nodiscard]] double interpolate(const DataArray& table, std::span<const double> point);

/// Bilinear interpolation in a picture: u to the right, v up; the centres of the border pixels lie
/// on the ends of the range. Outside it as in a data table.
[[nodiscard]] Rgb interpolate(const PictureData& picture, double u, double v);
/// The same in one band of a picture of spectra.
[[nodiscard]] double interpolate(const SpectralPicture& picture, double u, double v,
                                 std::size_t band);

}  // namespace lightwalk
