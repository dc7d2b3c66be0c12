#include "core/cloud/highlights.h"

#include <algorithm>
#include <cmath>

#include "core/material/lobes.h"

namespace lightwalk {
namespace {

constexpr double kChange = 0.05;     ///< of the colour
constexpr double kTurnMargin = 0.5;  ///< for the lobe's height, which changes with the cosines, too
constexpr double kLeastCosines = 0.1;
constexpr double kMostTurn = 0.8, kLeastTurn = 0.003;

/// A light from a point.
struct SeenLight {
    Vec3 direction;
    double omega = 0;   ///< [sr]
    double radius = 0;  ///< of a cone about it [rad]
};

SeenLight seen_from(const LightSource& light, const Vec3& point) {
    const double size = static_cast<double>(light.size);
    if (light.distant) return {light.center, size, std::sqrt(size / kPi)};
    const Vec3 way = light.center - point;
    const double squared = std::max(length_squared(way), kEpsilon);
    const double distance = std::sqrt(squared);
    const double half =
        std::sqrt(length_squared(light.u) + length_squared(light.v) + length_squared(light.w));
    return {way * (1 / distance), std::min(size / squared, 2 * kPi), std::atan(half / distance)};
}

}  // namespace

double steady_turn(double off, double alpha2, double peak) {
    const auto lobe = [&](double angle) { return peak * std::exp(-angle * angle / alpha2); };
    const double most = kTurnMargin * kChange * (1 + lobe(off));
    double turn = kMostTurn;
    while (turn > kLeastTurn && lobe(std::max(off - turn / 2, 0.0)) - lobe(off + turn / 2) > most)
        turn /= 2;
    return std::max(turn, kLeastTurn);
}

double Highlights::slope(const Hit& hit, const Vec3& direction, const GlossyLobe& lobe) const {
    const Vec3 normal = hit.cos_out >= 0 ? hit.normal : -hit.normal;
    const double alpha2 = lobe.alpha * lobe.alpha;
    const double piece = options_.source_subdivision * options_.source_subdivision;
    double turn = kMostTurn;
    for (const std::int32_t i : lights_.sampled()) {
        const SeenLight light = seen_from(lights_[i], hit.position);
        if (dot(light.direction, normal) + std::sin(std::min(light.radius, kPi / 2)) <= 0) continue;
        const Vec3 half = light.direction - direction;
        const double cosine = dot(half, normal) / std::max(length(half), kEpsilon);
        const double off = std::acos(std::clamp(cosine, -1.0, 1.0)) - light.radius / 2;
        const double omega = piece > 0 ? std::min(light.omega, piece) : light.omega;
        const double widened = alpha2 + light_widening(omega, options_.source_jitter);
        // Ward's lobe at δ = 0 is ρ/(πα²) over the square of the sum of both cosines (see
        // ward_reflection).
        const double cosines = std::max(dot(half, normal), kLeastCosines);
        const double peak =
            lobe.rho / std::max(lobe.diffuse * widened * cosines * cosines, kEpsilon);
        turn = std::min(turn, steady_turn(std::max(off, 0.0), widened, peak));
    }
    return turn < kMostTurn ? kChange / turn : 0;
}

}  // namespace lightwalk
