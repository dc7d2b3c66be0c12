#pragma once
// Rays sampled from rough specular lobes (-ss). They see everything but the light sources, whose
// highlights belong to the direct calculation.
#include <optional>

#include "core/material/lobes.h"
#include "core/transport/tracer.h"

namespace lightwalk {

/// A tilted microfacet: half vector n + tangent · (slopes), with the squared slope.
struct FacetSlope {
    Vec3 tangent;  ///< in the surface plane; its length is the tangent of the facet's tilt
    double squared = 0;
};

/// Draw a facet of Ward's Gaussian slope distribution of rms slopes alpha along u and v, from two
/// uniform numbers. Source: Ward, SIGGRAPH 1992, eqs. 6 and 7 (as corrected by Walter, Cornell
/// PCG-05-06).
[[nodiscard]] FacetSlope sample_ward_facet(const LobeFrame& frame, double alpha_u, double alpha_v,
                                           double xi1, double xi2);

/// Mirror direction off a facet; the half vector need not be normalised, `squared` is its length
/// squared.
[[nodiscard]] inline Vec3 reflect_off(const Vec3& v, const Vec3& half, double squared) {
    return v - half * (2 * dot(half, v) / squared);
}

/// Half vector of the Ashikhmin-Shirley distribution (unit); nothing for a number that gives none.
/// Source: Ashikhmin & Shirley, Journal of Graphics Tools 5 (2000), eqs. 9 and 10 in elliptic form.
[[nodiscard]] std::optional<Vec3> sample_ashikhmin_half(const LobeFrame& frame, double nu,
                                                        double nv, double xi1, double xi2);

/// How many samples a lobe gets: -ss in proportion to the ray's weight, but no more than the weight
/// limit bears.
/// @param weight  of the shaded ray; @param child_weight  of all samples together
[[nodiscard]] int rough_sample_count(const RenderOptions& options, double weight,
                                     double child_weight);

/// -ss below 1 narrows the lobe: 0 samples its centre only.
[[nodiscard]] inline double narrowed(double xi, double specular_samples) {
    return specular_samples >= 0 && specular_samples < 1 ? 1 - specular_samples * xi : xi;
}

/// Trace the samples of a lobe and add them to ray.value.
/// @param coef    what all samples together are multiplied by
/// @param draw    std::optional<Vec3>(Ray&): a unit direction, or nothing for a rejected trial
/// @param weight  double(direction, number of samples): factor of one sample's radiance
/// @param share_of_trials  rejected trials count as black when there are several samples
template <class Draw, class Weight>
void add_rough_samples(Ray& ray, RayKind kind, const Rgb& coef, TraceContext& context,
                       const Draw& draw, const Weight& weight, bool share_of_trials) {
    const Tracer& tracer = context.tracer;
    Ray prototype;
    if (!tracer.spawn(prototype, kind, ray, &coef)) return;
    const int count = rough_sample_count(tracer.options(), ray.weight, prototype.weight);
    prototype.coef *= 1.0f / static_cast<float>(count);
    prototype.weight /= count;
    Rgb sum;
    int accepted = 0, trials = 0;
    for (; accepted < count && trials < 10 * count; ++trials) {
        const std::optional<Vec3> direction = draw(ray);
        if (!direction) continue;
        Ray sample = prototype;
        if (accepted++ > 0) sample.random = ray.random.child();
        sample.direction = *direction;
        tracer.trace(sample, context);
        sum += sample.value * sample.coef * static_cast<float>(weight(*direction, count));
    }
    if (share_of_trials && count > 1) sum *= static_cast<float>(count) / static_cast<float>(trials);
    ray.value += sum;
}

/// Ward lobe, reflected off the shading normal frame.n; both kinds reject what the true surface
/// hides.
void add_rough_reflection(Ray& ray, const LobeFrame& frame, double alpha_u, double alpha_v,
                          const Rgb& coef, TraceContext& context);
/// Ward lobe about the transmitted direction w.
void add_rough_transmission(Ray& ray, const LobeFrame& frame, double alpha_u, double alpha_v,
                            const Vec3& w, const Rgb& coef, TraceContext& context);

}  // namespace lightwalk
