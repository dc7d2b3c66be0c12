#pragma once
// Fisheye pictures made for tests: discs of light on an even background.
#include <cmath>
#include <vector>

#include "core/glare/visual_field.h"
#include "core/math/rgbe.h"
#include "core/math/xyz.h"

namespace lightwalk::test {

/// Looks along y, up is z.
inline View fisheye_view(char type) {
    View view;
    view.type = type;
    view.horizontal = view.vertical = 180;
    return view;
}

/// A disc of light on the sphere. Its centre is `right` and `up` degrees from the line of sight, in
/// the coordinates of an angular fisheye picture.
struct LightDisc {
    double right = 0, up = 0;
    double radius = 1;       ///< [degrees]
    double luminance = 1e4;  ///< [cd/m²]
};

inline Vec3 direction_of(const LightDisc& disc) {
    const View view = fisheye_view('a');
    return Camera(view).ray(0.5 + disc.right / 180, 0.5 + disc.up / 180)->direction;
}

/// The grey radiance of a luminance, rounded as in a Radiance picture.
inline Rgb stored_grey(double luminance) {
    return decode_rgbe(encode_rgbe(Rgb::grey(static_cast<float>(luminance) / kEfficacy)));
}

/// A square picture of a view; black where the view has no ray. Later discs cover earlier ones.
inline std::vector<Rgb> disc_picture(int size, const View& view, double background,
                                     const std::vector<LightDisc>& discs) {
    const Camera camera(view);
    std::vector<Rgb> picture;
    for (int row = 0; row < size; ++row) {
        for (int x = 0; x < size; ++x) {
            const auto ray = camera.ray((x + 0.5) / size, 1 - (row + 0.5) / size);
            const bool seen = ray && dot(ray->direction, camera.forward()) >= 0;
            double luminance = seen ? background : 0;
            for (const LightDisc& disc : discs) {
                const double cosine = seen ? dot(ray->direction, direction_of(disc)) : -1;
                if (cosine >= std::cos(disc.radius * kPi / 180)) luminance = disc.luminance;
            }
            picture.push_back(stored_grey(luminance));
        }
    }
    return picture;
}

}  // namespace lightwalk::test
