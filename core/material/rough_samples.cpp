#include "core/material/rough_samples.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

constexpr int kMaxSamples = 1 << 20;

/// A sample of one of Ward's lobes, narrowed by -ss.
template <class Lobe>
std::optional<Vec3> draw_ward(Ray& ray, const Lobe& lobe, double specular_samples) {
    const auto [xi1, xi2] = ray.random.next_pair();
    return lobe.sample(ray.hit.normal, xi1, narrowed(xi2, specular_samples));
}

}  // namespace

int rough_sample_count(const RenderOptions& options, double weight, double child_weight) {
    if (!(options.specular_samples > 1.5)) return 1;
    double count = std::floor(options.specular_samples * weight + 0.5);
    if (child_weight <= options.weight_limit * count)
        count = std::floor(child_weight / options.weight_limit);
    return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(kMaxSamples)));
}

void add_rough_reflection(Ray& ray, const WardReflection& lobe, const Rgb& coef,
                          TraceContext& context) {
    const double samples = context.tracer.options().specular_samples;
    const Vec3 ng = ray.hit.normal;
    const double cos_o = ray.hit.cos_out;
    const auto draw = [&](Ray& from) { return draw_ward(from, lobe, samples); };
    const auto weight = [&](const Vec3& wi, int count) {
        return count > 1 ? WardReflection::weight(cos_o, dot(wi, ng)) : 1.0;
    };
    add_rough_samples(ray, kSpecularReflected, coef, context, draw, weight, true);
}

void add_rough_transmission(Ray& ray, const WardTransmission& lobe, const Rgb& coef,
                            TraceContext& context) {
    const double samples = context.tracer.options().specular_samples;
    const auto draw = [&](Ray& from) { return draw_ward(from, lobe, samples); };
    const auto weight = [](const Vec3&, int) { return 1.0; };
    add_rough_samples(ray, kSpecularTransmitted, coef, context, draw, weight, false);
}

void add_rough_reflection(Ray& ray, const AshikhminReflection& lobe, const Rgb& coef,
                          TraceContext& context) {
    const auto draw = [&](Ray& from) {
        const auto [xi1, xi2] = from.random.next_pair();
        return lobe.sample(from.hit.normal, xi1, xi2);
    };
    const auto weight = [](const Vec3&, int) { return 1.0; };
    add_rough_samples(ray, kSpecularReflected, coef, context, draw, weight, false);
}

}  // namespace lightwalk
