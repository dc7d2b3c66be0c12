#include "core/glare/visual_field.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/math/xyz.h"

namespace lightwalk {
namespace {

bool about(double value, double expected) {
    return std::abs(value - expected) <= 1e-3;
}

void check(const FieldPicture& picture, const View& view) {
    if (view.type != 'v' && !is_whole_fisheye(view)) {
        throw InputError(std::string("glare: the view is of type '") + view.type +
                         "', expected a fisheye, -vta or -vth -vh 180 -vv 180, or a perspective");
    }
    const bool sized = picture.width > 0 && picture.height > 0;
    const std::int64_t expected = std::int64_t{picture.width} * picture.height;
    if (!sized || static_cast<std::int64_t>(picture.radiance.size()) != expected) {
        throw InputError("glare: " + std::to_string(picture.radiance.size()) +
                         " values for a picture of " + std::to_string(picture.width) + " x " +
                         std::to_string(picture.height) + " pixels");
    }
}

/// Directions along a line of pixel corners, from the left.
std::vector<Vec3> corner_row(const Camera& camera, int width, double v) {
    std::vector<Vec3> row;
    row.reserve(static_cast<std::size_t>(width) + 1);
    for (int x = 0; x <= width; ++x) row.push_back(field_direction(camera, 1. * x / width, v));
    return row;
}

/// The direction of a pixel's centre, where it has a ray before the eye.
std::optional<Vec3> centre_direction(const Camera& camera, double h, double v) {
    const std::optional<Camera::ViewRay> ray = camera.ray(h, v);
    if (!ray || dot(ray->direction, camera.forward()) < 0) return std::nullopt;
    return ray->direction;
}

}  // namespace

bool is_whole_fisheye(const View& view) {
    return (view.type == 'a' || view.type == 'h') && about(view.horizontal, 180) &&
           about(view.vertical, 180) && view.shift == 0 && view.lift == 0;
}

Vec3 field_direction(const Camera& camera, double h, double v) {
    const double x = 2 * h - 1, y = 2 * v - 1;
    const double radius = std::hypot(x, y);
    if (camera.view().type == 'v' || radius < 1) {
        if (const std::optional<Camera::ViewRay> ray = camera.ray(h, v)) return ray->direction;
    }
    return (x / radius) * camera.right() + (y / radius) * camera.upward();
}

double triangle_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double volume = std::abs(dot(a, cross(b, c)));
    return 2 * std::atan2(volume, 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

VisualField visual_field(const FieldPicture& picture, const Camera& camera) {
    check(picture, camera.view());
    const auto width = static_cast<std::size_t>(picture.width);
    VisualField field;
    std::vector<Vec3> low = corner_row(camera, picture.width, 0);
    for (int y = 0; y < picture.height; ++y) {
        const std::vector<Vec3> high = corner_row(camera, picture.width, (y + 1.) / picture.height);
        const Rgb* row =
            picture.radiance.data() + static_cast<std::size_t>(picture.height - 1 - y) * width;
        for (std::size_t x = 0; x < width; ++x) {
            const double h = (static_cast<double>(x) + 0.5) / picture.width;
            const auto centre = centre_direction(camera, h, (y + 0.5) / picture.height);
            if (!centre) continue;
            const float luminance = kEfficacy * brightness(row[x]);
            if (!(luminance >= 0 && std::isfinite(luminance))) {
                ++field.dropped;
                continue;
            }
            // By way of the centre: at the rim of a tiny picture two corners may be antipodes.
            const double solid_angle = triangle_solid_angle(*centre, low[x], low[x + 1]) +
                                       triangle_solid_angle(*centre, low[x + 1], high[x + 1]) +
                                       triangle_solid_angle(*centre, high[x + 1], high[x]) +
                                       triangle_solid_angle(*centre, high[x], low[x]);
            field.pixels.push_back(
                {{static_cast<int>(x), y}, *centre, solid_angle, static_cast<double>(luminance)});
        }
        low = high;
    }
    return field;
}

}  // namespace lightwalk
