#include "core/transport/contribution.h"

#include <cmath>

namespace lightwalk {
namespace {

constexpr float kThinnest = 1e-10f;  ///< extinction that takes nothing [1/m]
constexpr double kOpaque = 92;       ///< optical depth beyond which nothing is left

bool all_finite(const Rgb& c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

}  // namespace

Rgb transmittance(const Medium& medium, double distance, bool shadow) {
    if (max_component(medium.extinction) <= kThinnest) return {1, 1, 1};
    Rgb left;
    for (std::size_t i = 0; i < 3; ++i) {
        double depth = distance * static_cast<double>(medium.extinction[i]);
        if (shadow) depth *= 1 - static_cast<double>(medium.albedo[i]);
        left[i] = depth <= kEpsilon ? 1.0f
                  : depth > kOpaque ? 0.0f
                                    : static_cast<float>(std::exp(-depth));
    }
    return left;
}

Rgb path_coefficient(const Ray& ray, const Ray* root) {
    Rgb product = ray.coef;
    for (const Ray* at = ray.parent; at != root && at != nullptr; at = at->parent)
        product *= at->coef * transmittance(at->medium, at->hit.t, at->in(kShadow));
    return product;
}

Rgb path_throughput(const Ray& ray, const Ray* root) {
    return path_coefficient(ray, root) * transmittance(ray.medium, ray.hit.t, ray.in(kShadow));
}

void tell(const Contribution& term, ContributionSink& sink) {
    if (all_finite(term.coefficient) && all_finite(term.value)) sink.add(term);
}

void tell_emission(const Ray& ray, ContributionSink& sink) {
    if (ray.aimed) return;
    const Rgb coefficient = path_throughput(ray, sink.root());
    tell({ray.hit.modifier, ray.direction, ray.hit.position, coefficient, coefficient * ray.value},
         sink);
}

void tell_constant(const Ray& ray, const Rgb& coefficient, const Rgb& radiance,
                   ContributionSink& sink) {
    if (ray.aimed || radiance == Rgb{}) return;
    tell({kVoid, {}, {}, coefficient, coefficient * radiance}, sink);
}

}  // namespace lightwalk
