#pragma once
// The visual field: a picture as luminances in directions, each with its solid angle.
#include <cstddef>
#include <span>
#include <vector>

#include "core/math/rgb.h"
#include "core/view/pixels.h"
#include "core/view/view.h"

namespace lightwalk {

/// A picture as radiances.
struct FieldPicture {
    int width = 0, height = 0;
    std::span<const Rgb> radiance;  ///< rows from the top, width * height of them [W/(m² sr)]
};

/// A pixel of the visual field.
struct FieldPixel {
    PixelPlace place;        ///< y from the bottom
    Vec3 direction;          ///< of its centre, unit
    double solid_angle = 0;  ///< [sr]
    double luminance = 0;    ///< [cd/m²]
};

/// What a picture shows before the eye.
struct VisualField {
    std::vector<FieldPixel> pixels;  ///< row by row from the bottom, those with a ray
    std::size_t dropped = 0;  ///< pixels left out because their luminance is negative or not finite
};

/// The pixels of a picture as directions. The solid angle of a pixel is that of its four corners on
/// the sphere, cut off at the plane of the eye; those of a fisheye sum to 2 π, but for slivers of
/// pixels whose centre lies outside.
/// @return  no pixels behind the plane of the eye
/// Throws InputError unless the view is a perspective (v) or a fisheye (a, h) of 180 degrees
/// without shift and lift, with a luminance for each pixel. Time and memory: proportional to the
/// pixels.
[[nodiscard]] VisualField visual_field(const FieldPicture& picture, const Camera& camera);

/// Whether the view is a fisheye that shows all that is before the eye: type a or h, 180 by 180
/// degrees within the 1e-3 that view files keep, neither shifted nor lifted.
[[nodiscard]] bool is_whole_fisheye(const View& view);

/// The direction seen at an image position of a perspective or of a fisheye of 180 degrees. Beyond
/// the rim of a fisheye: the direction of the nearest place on the rim, at a right angle to the
/// line of sight.
[[nodiscard]] Vec3 field_direction(const Camera& camera, double h, double v);

/// The solid angle of a spherical triangle [sr] whose corners are unit vectors. Source: Van
/// Oosterom & Strackee, "The solid angle of a plane triangle", IEEE Transactions on Biomedical
/// Engineering 30 (1983).
[[nodiscard]] double triangle_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace lightwalk
