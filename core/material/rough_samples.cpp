#include "core/material/rough_samples.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

constexpr int kMaxSamples = 1 << 20;

FacetSlope draw_facet(Ray& ray, const LobeFrame& frame, double alpha_u, double alpha_v,
                      double samples) {
    const double xi1 = ray.random.next();
    const double xi2 = narrowed(ray.random.next(), samples);
    return sample_ward_facet(frame, alpha_u, alpha_v, xi1, xi2);
}

}  // namespace

FacetSlope sample_ward_facet(const LobeFrame& frame, double alpha_u, double alpha_v, double xi1,
                             double xi2) {
    double c = alpha_u * std::cos(2 * kPi * xi1);
    double s = alpha_v * std::sin(2 * kPi * xi1);
    const double size = std::hypot(c, s);
    c /= size;
    s /= size;
    double squared = 1;
    if (xi2 > kEpsilon) {
        squared = -std::log(xi2) / (c * c / (alpha_u * alpha_u) + s * s / (alpha_v * alpha_v));
    }
    return {(frame.u * c + frame.v * s) * std::sqrt(squared), squared};
}

std::optional<Vec3> sample_ashikhmin_half(const LobeFrame& frame, double nu, double nv, double xi1,
                                          double xi2) {
    double c = std::sqrt(nv + 1) * std::cos(2 * kPi * xi1);
    double s = std::sqrt(nu + 1) * std::sin(2 * kPi * xi1);
    const double size = std::hypot(c, s);
    c /= size;
    s /= size;
    const double cosine = std::pow(xi2, 1 / (nu * c * c + nv * s * s + 1));
    if (!(cosine > kEpsilon)) return std::nullopt;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return frame.u * (c * sine) + frame.v * (s * sine) + frame.n * cosine;
}

int rough_sample_count(const RenderOptions& options, double weight, double child_weight) {
    if (!(options.specular_samples > 1.5)) return 1;
    double count = std::floor(options.specular_samples * weight + 0.5);
    if (child_weight <= options.weight_limit * count)
        count = std::floor(child_weight / options.weight_limit);
    return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(kMaxSamples)));
}

void add_rough_reflection(Ray& ray, const LobeFrame& frame, double alpha_u, double alpha_v,
                          const Rgb& coef, TraceContext& context) {
    const double samples = context.tracer.options().specular_samples;
    const Vec3 true_normal = ray.hit.normal;
    const double cos_out = ray.hit.cos_out;
    const auto draw = [&](Ray& from) -> std::optional<Vec3> {
        const FacetSlope facet = draw_facet(from, frame, alpha_u, alpha_v, samples);
        const Vec3 l = reflect_off(from.direction, frame.n + facet.tangent, 1 + facet.squared);
        if (dot(l, true_normal) <= kEpsilon) return std::nullopt;
        return l;
    };
    // f cosθ / pdf of the bounded-albedo lobe; a single sample goes without, as a rejected trial is
    // drawn again.
    const auto weight = [&](const Vec3& l, int count) {
        return count > 1 ? 2 / (1 + cos_out / dot(l, true_normal)) : 1.0;
    };
    add_rough_samples(ray, kSpecularReflected, coef, context, draw, weight, true);
}

void add_rough_transmission(Ray& ray, const LobeFrame& frame, double alpha_u, double alpha_v,
                            const Vec3& w, const Rgb& coef, TraceContext& context) {
    const double samples = context.tracer.options().specular_samples;
    const Vec3 true_normal = ray.hit.normal;
    const auto draw = [&](Ray& from) -> std::optional<Vec3> {
        const FacetSlope facet = draw_facet(from, frame, alpha_u, alpha_v, samples);
        const Vec3 l = w + facet.tangent;
        if (dot(l, true_normal) >= -kEpsilon) return std::nullopt;
        return normalize(l);
    };
    const auto weight = [](const Vec3&, int) { return 1.0; };
    add_rough_samples(ray, kSpecularTransmitted, coef, context, draw, weight, false);
}

}  // namespace lightwalk
