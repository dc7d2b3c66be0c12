#include "core/cloud/sight.h"

#include <algorithm>

namespace lightwalk {
namespace {

/// The point of one sight, unless nothing of it can be reused.
void add_point(const Sight& sight, const Rgb& radiance, const TracedPixel& pixel, double tolerance,
               PixelPoints& result) {
    if (!sight.seen || sight.slope == kUnsteady) return;
    CloudPoint& point = result.points[result.count++];
    point.position = {static_cast<float>(sight.position.x), static_cast<float>(sight.position.y),
                      static_cast<float>(sight.position.z)};
    point.radiance = radiance;
    point.surface = sight.surface;
    point.direction = encode_direction(pixel.sights.direction);
    point.kind = sight.kind;
    // What is faint beside the other sight may change more.
    const double whole = static_cast<double>(brightness(pixel.radiance));
    const double part = static_cast<double>(brightness(radiance));
    const double change = static_cast<double>(sight.slope) * part;
    constexpr double kHalfTurn = kPi;
    if (change * kHalfTurn > tolerance * whole)
        point.turn = static_cast<float>(tolerance * whole / change);
}

}  // namespace

PixelPoints points_of(const TracedPixel& pixel, double tolerance) {
    PixelPoints result;
    if (!pixel.sights.ray) return result;
    const PixelSights& sights = pixel.sights;
    // A pixel is reused whole: a point without its partner would never be.
    if ((sights.ahead.seen && sights.ahead.slope == kUnsteady) ||
        (sights.mirrored.seen && sights.mirrored.slope == kUnsteady))
        return result;
    const Rgb mirrored = sights.mirrored.seen ? pixel.mirrored : Rgb{};
    add_point(sights.ahead, pixel.radiance - mirrored, pixel, tolerance, result);
    add_point(sights.mirrored, sights.ahead.seen ? mirrored : pixel.radiance, pixel, tolerance,
              result);
    for (CloudPoint& point : result.points) point.paired = result.count == 2;
    return result;
}

}  // namespace lightwalk
