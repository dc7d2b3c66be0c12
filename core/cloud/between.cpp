#include "core/cloud/between.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

/// A plane seen at a grazing angle changes its distance by less from a pixel to the one after the
/// next; more is a step.
constexpr float kStep = 0.1f;

bool alike(const Sight& a, const Sight& b) {
    if (a.seen != b.seen) return false;
    if (!a.seen) return true;
    return a.surface == b.surface && a.kind == b.kind &&
           (a.slope == kUnsteady) == (b.slope == kUnsteady) &&
           std::abs(a.distance - b.distance) <= kStep * std::min(a.distance, b.distance);
}

Sight mean_sight(std::span<const PixelSights* const> all, Sight PixelSights::*which) {
    Sight sight = all.front()->*which;
    if (!sight.seen) return sight;
    Vec3 position;
    float distance = 0;
    for (const PixelSights* one : all) {
        position += (one->*which).position;
        distance += (one->*which).distance;
    }
    const auto count = static_cast<float>(all.size());
    sight.position = position * (1 / static_cast<double>(count));
    sight.distance = distance / count;
    return sight;
}

}  // namespace

bool see_alike(const PixelSights& a, const PixelSights& b) {
    return a.ray && b.ray && alike(a.ahead, b.ahead) && alike(a.mirrored, b.mirrored);
}

PixelSights sights_between(std::span<const PixelSights* const> pairs, const PixelPlace& pixel) {
    PixelSights sights;
    sights.ray = true;
    Vec3 direction;
    for (const PixelSights* one : pairs) direction += one->direction;
    sights.direction = normalize(direction);
    sights.x = static_cast<float>(pixel.x) + 0.5f;
    sights.y = static_cast<float>(pixel.y) + 0.5f;
    sights.ahead = mean_sight(pairs, &PixelSights::ahead);
    sights.mirrored = mean_sight(pairs, &PixelSights::mirrored);
    return sights;
}

}  // namespace lightwalk
