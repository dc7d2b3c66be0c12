#pragma once
// Rays that are sampled from rough specular lobes (-ss). They see everything but the light sources,
// whose highlights belong to the direct calculation.
#include <optional>

#include "core/material/lobes.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

/// How many samples a lobe gets: -ss in proportion to the ray's weight, but no more than the weight
/// limit bears.
/// @param weight  of the shaded ray; @param child_weight  of all samples together
[[nodiscard]] int rough_sample_count(const RenderOptions& options, double weight,
                                     double child_weight);

/// The uniform number that decides how far from its centre a Ward lobe is sampled: -ss below 1
/// takes only that share of the lobe which is nearest to the centre, where the density is larger by
/// 1 / -ss; 0 samples the centre only.
[[nodiscard]] inline double narrowed(double xi, double specular_samples) {
    return specular_samples >= 0 && specular_samples < 1 ? 1 - specular_samples * xi : xi;
}

/// How many trials add_rough_samples() will need for `count` samples.
template <class Draw>
int count_trials(Ray& ray, int count, const Draw& draw) {
    const RandomStream before = ray.random;
    int accepted = 0, trials = 0;
    for (; accepted < count && trials < 10 * count; ++trials)
        if (draw(ray) && accepted++ > 0) (void)ray.random.child();
    ray.random = before;
    return trials;
}

/// Trace the samples of a lobe and add what they see to ray.value. A trial that gives nothing is
/// drawn again, up to ten times a sample in the mean: the density of what is traced is the lobe's
/// over the probability that a trial is accepted.
/// @param coef    what all samples together are multiplied by
/// @param draw    std::optional<Vec3>(Ray&): a unit direction wi, or nothing for a rejected trial
/// @param weight  double(wi, number of samples): factor of one sample's radiance
/// @param share_of_trials  where there are several samples, rejected trials count as black: the sum
///                         is over all that were drawn
template <class Draw, class Weight>
void add_rough_samples(Ray& ray, RayKind kind, const Rgb& coef, TraceContext& context,
                       const Draw& draw, const Weight& weight, bool share_of_trials) {
    const LightTransport& tracer = context.tracer;
    Ray prototype;
    if (!tracer.spawn(prototype, kind, ray, &coef)) return;
    const int count = rough_sample_count(tracer.options(), ray.weight, prototype.weight);
    prototype.coef *= 1.0f / static_cast<float>(count);
    prototype.weight /= count;
    const bool scaled = share_of_trials && count > 1;
    const auto scale = [&](int trials) {
        return static_cast<float>(count) / static_cast<float>(trials);
    };
    // Who is told the terms of the radiance needs the scale before the samples are traced.
    const float told_scale =
        scaled && context.contributions ? scale(count_trials(ray, count, draw)) : 1;
    Rgb sum;
    int accepted = 0, trials = 0;
    for (; accepted < count && trials < 10 * count; ++trials) {
        const std::optional<Vec3> direction = draw(ray);
        if (!direction) continue;
        Ray sample = prototype;
        if (accepted++ > 0) sample.random = ray.random.child();
        sample.direction = *direction;
        const auto factor = static_cast<float>(weight(*direction, count));
        sample.coef *= factor * told_scale;
        tracer.trace(sample, context);
        // What must not be counted sets the coefficient to 0.
        if (sample.coef != Rgb{}) sum += sample.value * prototype.coef * factor;
    }
    if (scaled) sum *= scale(trials);
    ray.value += sum;
}

/// Sample Ward's reflected lobe. Several samples weigh f cosθ / pdf each (with the cosines to the
/// surface's own normal); a single one weighs 1.
void add_rough_reflection(Ray& ray, const WardReflection& lobe, const Rgb& coef,
                          TraceContext& context);
/// Sample Ward's transmitted lobe. Samples weigh 1, as in Radiance.
void add_rough_transmission(Ray& ray, const WardTransmission& lobe, const Rgb& coef,
                            TraceContext& context);
/// Sample the Ashikhmin-Shirley lobe. Samples weigh 1, as in Radiance, where f cosθ / pdf is cosθi
/// / max(cosθi, cosθo).
void add_rough_reflection(Ray& ray, const AshikhminReflection& lobe, const Rgb& coef,
                          TraceContext& context);

}  // namespace lightwalk
