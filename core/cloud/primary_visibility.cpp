#include "core/cloud/primary_visibility.h"

#include <algorithm>

namespace lightwalk {
namespace {

/// Adds the point of one visible place, unless it can never be reused.
void add_point(const PrimaryVisibility& primary, const Rgb& radiance, const TracedPixel& pixel,
               double tolerance, PixelPoints& result) {
    if (!primary.seen || primary.slope == kNeverReuse) return;
    CloudPoint& point = result.points[result.count++];
    point.position = {static_cast<float>(primary.position.x),
                      static_cast<float>(primary.position.y),
                      static_cast<float>(primary.position.z)};
    point.radiance = radiance;
    point.surface = primary.surface;
    point.direction = encode_direction(pixel.visibility.direction);
    point.kind = primary.kind;
    point.pattern = encode_pattern(primary.pattern);
    // Where this part is faint beside the other one, larger relative changes are tolerable.
    const double whole = static_cast<double>(brightness(pixel.radiance));
    const double part = static_cast<double>(brightness(radiance));
    const double change = static_cast<double>(primary.slope) * part;
    constexpr double kHalfTurn = kPi;
    if (change * kHalfTurn > tolerance * whole)
        point.max_view_angle = static_cast<float>(tolerance * whole / change);
}

}  // namespace

PixelPoints points_of(const TracedPixel& pixel, double tolerance) {
    PixelPoints result;
    if (!pixel.visibility.ray) return result;
    const PixelVisibility& visibility = pixel.visibility;
    // Both points of a pixel are needed to reuse it: where one is missing, none is stored.
    if ((visibility.ahead.seen && visibility.ahead.slope == kNeverReuse) ||
        (visibility.mirrored.seen && visibility.mirrored.slope == kNeverReuse))
        return result;
    const Rgb mirrored = visibility.mirrored.seen ? pixel.mirrored : Rgb{};
    add_point(visibility.ahead, pixel.radiance - mirrored, pixel, tolerance, result);
    add_point(visibility.mirrored, visibility.ahead.seen ? mirrored : pixel.radiance, pixel,
              tolerance, result);
    for (CloudPoint& point : result.points) point.paired = result.count == 2;
    return result;
}

}  // namespace lightwalk
