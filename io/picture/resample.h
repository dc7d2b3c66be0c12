#pragma once
// Pictures in other sizes.
#include "io/picture/picture.h"

namespace lightwalk {

/// A picture of another size whose pixels are means of those that they cover.
/// @param radius  0: a box, in which each pixel belongs to one of the new ones (where these are
///                smaller, each takes the pixel at its middle). Else a Gaussian, exp(-(d /
///                radius)^2) at the distance d from the middle of a new pixel [its width, its
///                height], cut off beyond 2.2 radii
/// @param width   of the new picture, at least 1; height alike
/// The weights are those of pfilt(1): of its Gaussian to within 4 %, as it takes them from a table.
[[nodiscard]] Picture resampled(const Picture& picture, int width, int height, double radius);

}  // namespace lightwalk
