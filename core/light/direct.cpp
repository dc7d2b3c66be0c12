// Direct light on surfaces.
#include <algorithm>
#include <cmath>

#include "core/light/direct_calculation.h"

namespace lightwalk {

DirectCalculation::DirectCalculation(const LightSources& lights, Ray& ray, TraceContext& context)
    : lights_(lights),
      tracer_(context.tracer),
      ray_(ray),
      context_(context),
      scratch_(*context.light),
      first_sample_(scratch_.samples.size()),
      first_candidate_(scratch_.candidates.size()),
      first_tail_(scratch_.tails.size()) {
    (void)tracer_.spawn(aimed_, kShadow, ray, nullptr);
    aimed_.aimed = true;
    random_ = aimed_.random;
    part_size_ = partition_size(tracer_.options().source_subdivision, aimed_.weight);
}

DirectCalculation::~DirectCalculation() {
    scratch_.samples.resize(first_sample_);
    scratch_.candidates.resize(first_candidate_);
    scratch_.tails.resize(first_tail_);
}

void DirectCalculation::gather(DirectCoefficient coefficient, const Vec3* front) {
    for (const std::int32_t source : lights_.sampled()) {
        const LightSource& light = lights_[source];
        if (out_of_reach(light, ray_.hit.position)) continue;
        if (front && is_behind(light, ray_.hit.position, *front)) continue;
        gather(source, coefficient);
    }
}

void DirectCalculation::gather(std::int32_t index, DirectCoefficient coefficient) {
    const LightSource& source = lights_[index];
    const double jitter = tracer_.options().source_jitter;
    partition(source, ray_.hit.position, part_size_, scratch_.parts);
    if (scratch_.parts.count == 1) {  // most
        if (const auto sample = sample_whole(source, ray_.hit.position, jitter, random_))
            consider(index, *sample, coefficient);
        return;
    }
    sample_parts(source, scratch_.parts, ray_.hit.position, jitter, random_, scratch_.samples);
    for (std::size_t i = first_sample_; i < scratch_.samples.size(); ++i) {
        const SourceSample sample = scratch_.samples[i];  // tracing may move them
        consider(index, sample, coefficient);
    }
    scratch_.samples.resize(first_sample_);
}

/// Make a candidate of a sample that can bring light.
void DirectCalculation::consider(std::int32_t index, const SourceSample& sample,
                                 DirectCoefficient coefficient) {
    const LightSource& source = lights_[index];
    if (source.is_virtual && !meets_relay(source, sample.direction)) return;
    const Rgb k = coefficient(sample.direction, sample.solid_angle);
    if (!(max_component(k) > 0)) return;
    if (is_constant(source)) {
        if (const auto distance = front_distance(source, sample.direction))
            add_candidate(index, sample.direction, k, {source.radiance, *distance});
    } else if (!source.is_virtual && !needs_tracing(source)) {
        if (const auto distance = plane_distance(source, sample.direction))
            add_unknown(index, sample.direction, k, *distance);
    } else {
        add_candidate(index, sample.direction, k, traced_emission(index, sample.direction));
    }
}

/// A candidate whose radiance is not known yet.
void DirectCalculation::add_unknown(std::int32_t source, const Vec3& direction,
                                    const Rgb& coefficient, double distance) {
    const auto order = static_cast<std::uint32_t>(count());
    scratch_.candidates.push_back(
        {source, order, direction, distance, coefficient, {}, 0, CandidateState::unknown});
}

/// Unless nothing arrives.
void DirectCalculation::add_candidate(std::int32_t source, const Vec3& direction,
                                      const Rgb& coefficient, const Emission& emitted) {
    const Rgb contribution = coefficient * emitted.radiance;
    const float b = brightness(contribution);
    if (!brings_light(b)) return;
    const auto order = static_cast<std::uint32_t>(count());
    scratch_.candidates.push_back({source, order, direction, emitted.distance, coefficient,
                                   contribution, b, CandidateState::known});
}

/// Most samples of a virtual source pass its mirror by: the outline says so before a ray is traced.
bool DirectCalculation::meets_relay(const LightSource& source, const Vec3& direction) const {
    return tracer_.scene()
        .geometry()
        .intersect_surface(source.object, {ray_.hit.position, direction, kHuge})
        .exists();
}

bool DirectCalculation::in_clear_air() const {
    return max_component(ray_.medium.extinction) <= 1e-10f;
}

/// Whether a source has no patterns and the air is clear: its radiance is its material's colour
/// where a ray meets its front.
bool DirectCalculation::is_constant(const LightSource& source) const {
    return source.uniform && !source.is_virtual && in_clear_air();
}

/// How far the front of a source is; nothing when the direction misses it or meets its back.
std::optional<double> DirectCalculation::front_distance(const LightSource& source,
                                                        const Vec3& direction) const {
    if (source.distant) {
        const bool inside =
            2 * kPi * (1 - dot(source.center, direction)) <= static_cast<double>(source.size);
        return inside ? std::optional(kHuge) : std::nullopt;
    }
    const Surface& surface = tracer_.scene().surface(source.object);
    const auto hit = intersect(surface.shape, ray_.hit.position, direction, kHuge);
    if (!hit || dot(hit->normal, direction) > 0) return std::nullopt;
    return hit->t;
}

/// The same for polygons without asking whether the direction meets the outline: traced_emission
/// does, where it matters.
std::optional<double> DirectCalculation::plane_distance(const LightSource& source,
                                                        const Vec3& direction) const {
    const auto* polygon =
        source.distant ? nullptr
                       : std::get_if<PolygonShape>(&tracer_.scene().surface(source.object).shape);
    if (!polygon) return front_distance(source, direction);
    const double cosine = fused_dot(polygon->normal, direction);
    if (!(cosine < -kEpsilon)) return std::nullopt;
    const double t = (polygon->offset - fused_dot(polygon->normal, ray_.hit.position)) / cosine;
    return t > kEpsilon ? std::optional(t) : std::nullopt;
}

void DirectCalculation::sort() {
    find_radiances(0, count(), CandidateState::unknown);
    auto& all = scratch_.candidates;
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(first_candidate_);
    const auto is_dark = [](const LightCandidate& c) { return c.state == CandidateState::dark; };
    all.erase(std::remove_if(first, all.end(), is_dark), all.end());
    std::sort(first, all.end(), [](const LightCandidate& a, const LightCandidate& b) {
        return a.brightness != b.brightness ? a.brightness > b.brightness : a.order < b.order;
    });
    scratch_.tails.resize(first_tail_);
    scratch_.tails.resize(first_tail_ + count() + 1, 0.0f);
    for (std::size_t i = count(); i-- > 0;) {
        scratch_.tails[first_tail_ + i] = scratch_.tails[first_tail_ + i + 1] +
                                          scratch_.candidates[first_candidate_ + i].brightness;
    }
}

bool DirectCalculation::needs_tracing(const LightSource& source) const {
    return source.follow || ray_.clip || ray_.next_clip;
}

/// Whether the light is behind the true surface.
bool DirectCalculation::goes_through(const Vec3& direction) const {
    return (ray_.hit.cos_out > 0) != (dot(direction, ray_.hit.normal) > 0);
}

/// What a ray that only asks for opaque surfaces finds between the point and the light.
Visibility DirectCalculation::visibility(const LightCandidate& candidate) {
    const LightSource& source = lights_[candidate.source];
    const bool local = !source.distant || source.is_virtual;
    RaySegment segment{ray_.hit.position, candidate.direction,
                       local ? candidate.distance - kEpsilon : kHuge};
    // Rays through the surface keep what is left to the aft clipping plane.
    if (ray_.limit > kEpsilon && ray_.limit - ray_.hit.t > kEpsilon &&
        goes_through(candidate.direction)) {
        segment.t_max = std::min(segment.t_max, ray_.limit - ray_.hit.t);
    }
    const auto i = static_cast<std::size_t>(candidate.source);
    if (i >= scratch_.blockers.size()) scratch_.blockers.resize(lights_.all().size());
    return tracer_.scene().geometry().visibility(segment, local ? source.object : kNoSurface,
                                                 &scratch_.blockers[i]);
}

void DirectCalculation::test(std::size_t first, std::size_t last) {
    context_.counters.shadow += last - first;
    for (std::size_t i = first_candidate_ + first; i < first_candidate_ + last; ++i) {
        LightCandidate& candidate = scratch_.candidates[i];
        Visibility found =
            needs_tracing(lights_[candidate.source]) ? Visibility::special : visibility(candidate);
        if (context_.observer && found == Visibility::clear) found = Visibility::special;
        switch (found) {
            case Visibility::clear:
                set_seen(candidate);
                break;
            case Visibility::blocked:
                set_dark(candidate);
                break;
            case Visibility::special:
                trace_shadow(i);  // may move the candidates
        }
    }
    find_radiances(first, last, CandidateState::seen);
}

void DirectCalculation::set_seen(LightCandidate& candidate) {
    candidate.state =
        candidate.state == CandidateState::unknown ? CandidateState::seen : CandidateState::lit;
}

void DirectCalculation::set_dark(LightCandidate& candidate) {
    candidate.state = CandidateState::dark;
    candidate.contribution = Rgb{};
}

bool DirectCalculation::has_unknown() const {
    return std::any_of(candidates().begin(), candidates().end(),
                       [](const LightCandidate& c) { return c.state == CandidateState::unknown; });
}

/// Follow one shadow ray through whatever is in the way.
void DirectCalculation::trace_shadow(std::size_t i) {
    const Vec3 direction = scratch_.candidates[i].direction;
    Ray shadow;
    (void)tracer_.spawn(shadow, goes_through(direction) ? kShadowThrough : kShadowSame, ray_,
                        nullptr);
    shadow.direction = direction;
    shadow.coef = scratch_.candidates[i].coefficient;
    shadow.target = scratch_.candidates[i].source;
    tracer_.trace(shadow, context_);
    LightCandidate& candidate = scratch_.candidates[i];
    if (!shadow.hit.exists()) {  // at the aft clipping plane: what lies beyond does not shadow
        set_seen(candidate);
    } else if (static_cast<double>(mean(shadow.value)) > kEpsilon) {
        candidate.state = CandidateState::lit;
        candidate.contribution = candidate.coefficient * shadow.value;
    } else {
        set_dark(candidate);
    }
}

void LightSources::add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context,
                              const Vec3* front) const {
    if (sampled_.empty() || context.misses != nullptr) return;
    DirectCalculation direct(*this, ray, context);
    direct.gather(coefficient, front);
    if (options_.shadow_threshold <= 0 || direct.count() <= kFirstBlock ||
        (direct.has_unknown() && direct.count() <= kFewPatterned)) {
        if (context.observer) direct.sort();  // it is told of the brightest first
        direct.test(0, direct.count());
        for (const LightCandidate& candidate : direct.candidates())
            ray.value += candidate.contribution;
        return;
    }
    direct.sort();
    ShadowTally tally;
    tally.brightness = brightness(ray.value);
    const auto test_block = [&](std::size_t first, std::size_t last) {
        direct.test(first, last);
        for (const LightCandidate& candidate : direct.candidates().subspan(first, last - first)) {
            tally.hits += candidate.state == CandidateState::lit ? 1 : 0;
            tally.expected += static_cast<double>((*this)[candidate.source].hit_rate);
            ray.value += candidate.contribution;
        }
        tally.brightness = brightness(ray.value);
    };
    const std::size_t tested =
        test_brightest(direct.tails(), options_.shadow_certainty,
                       options_.shadow_threshold / ray.weight, tally, test_block);
    const auto factor = static_cast<float>(tally.factor());
    for (const LightCandidate& candidate : direct.candidates().subspan(tested)) {
        ray.value +=
            candidate.contribution * std::min(1.0f, factor * (*this)[candidate.source].hit_rate);
    }
}

}  // namespace lightwalk
