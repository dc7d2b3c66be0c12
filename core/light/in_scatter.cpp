// Single scattering of listed light sources along a ray. Source: the mist material of "The
// Radiance 6.x Scene Description Language"; phase function of Henyey & Greenstein (1941).
#include <cmath>

#include "core/light/light_sources.h"
#include "core/light/partition.h"

namespace lightwalk {
namespace {

constexpr int kMaxSteps = 16;

int steps_along(double length, double step) {
    if (step <= kEpsilon) return 1;
    return static_cast<int>(
        std::clamp(std::floor(length / step + 0.5), 1.0, static_cast<double>(kMaxSteps)));
}

/// Henyey-Greenstein phase function times 4π.
double phase(double g, double cosine) {
    if (g <= kEpsilon) return 1;
    return (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
}

}  // namespace

void LightSources::add_in_scatter(Ray& ray, TraceContext& context) const {
    if (context.ambient.missing != nullptr) return;
    const Medium medium = ray.medium;
    const auto g = static_cast<double>(medium.eccentricity);
    if (!medium.scatter || is_infinite(ray.hit.t) || g >= 1 - kEpsilon) return;
    const int steps = steps_along(ray.hit.t, options_.scatter_step);
    const double step = ray.hit.t / steps;
    Ray at_step = ray;
    for (const std::int32_t index : medium.scatter->sources) {
        const LightSource& source = (*this)[index];
        if (source.unusable) continue;
        for (int j = 0; j < steps; ++j) {
            at_step.hit.t = step * (j + ray.random.next());
            at_step.hit.position = ray.origin + ray.direction * at_step.hit.t;
            if (out_of_reach(source, at_step.hit.position)) continue;
            const auto sample =
                sample_whole(source, at_step.hit.position, options_.source_jitter, ray.random);
            if (!sample) continue;
            Ray to_light;
            (void)context.tracer.spawn(to_light, kShadow, at_step, nullptr);
            to_light.direction = sample->direction;
            to_light.target = index;
            ++context.counters.rays.shadow;
            const double weight = sample->solid_angle / (4 * kPi) *
                                  phase(g, dot(ray.direction, sample->direction)) * step;
            // The way back through the medium is that of `at_step`.
            to_light.coef = medium.albedo * medium.extinction * static_cast<float>(weight);
            context.tracer.trace(to_light, context);
            for (std::size_t c = 0; c < 3; ++c) {
                const auto extinction = static_cast<double>(medium.extinction[c]);
                ray.value[c] +=
                    to_light.value[c] * medium.albedo[c] *
                    static_cast<float>(weight * extinction * std::exp(-at_step.hit.t * extinction));
            }
        }
    }
}

}  // namespace lightwalk
