// What light sources send towards a point, when nothing else is in the scene.
#include <array>
#include <cmath>
#include <span>

#include "core/geometry/polygon.h"
#include "core/light/direct_calculation.h"
#include "core/texture/function_binding.h"

namespace lightwalk {

bool brings_light(float brightness) {
    return brightness > 0 && std::isfinite(brightness);
}

/// A ray that sees the source and nothing else.
Ray DirectCalculation::aimed_ray(std::int32_t source, const Vec3& direction) const {
    Ray ray = aimed_;
    ray.direction = direction;
    ray.target = source;
    ray.random = random_;
    return ray;
}

/// Where a candidate's direction meets the front of its source; false: it misses. On polygons the
/// distance is known already, and only the outline remains to be asked.
bool DirectCalculation::meet(const LightCandidate& candidate, Hit& hit) const {
    const LightSource& source = lights_[candidate.source];
    const Surface& surface = tracer_.scene().surface(source.object);
    const Vec3& direction = candidate.direction;
    const double t = candidate.distance;
    const auto* polygon = source.distant ? nullptr : std::get_if<PolygonShape>(&surface.shape);
    if (!polygon || polygon->vertices.size() > kLargePolygon) {  // those have an index of their own
        Ray aimed = aimed_ray(candidate.source, direction);
        if (!lights_.intersect_target(aimed, tracer_) || aimed.hit.cos_out < 0) return false;
        hit = aimed.hit;
        return true;
    }
    if (!contains(*polygon, aimed_.origin + direction * t, nullptr)) return false;
    hit = Hit{};
    hit.t = t;
    hit.position = fused_advance(aimed_.origin, direction, t);
    hit.normal = polygon->normal;
    hit.cos_out = -fused_dot(direction, hit.normal);
    hit.surface = source.object;
    hit.modifier = surface.modifier;
    return true;
}

/// Radiance of the real source of a candidate. For plain ones the ray's way through materials is
/// cut short.
Rgb DirectCalculation::emission(const LightCandidate& candidate) const {
    const LightSource& source = lights_[candidate.source];
    if (!source.plain || !in_clear_air())
        return traced_emission(candidate.source, candidate.direction).radiance;
    Hit hit;
    if (!meet(candidate, hit)) return {};
    Ray aimed = aimed_ray(candidate.source, candidate.direction);
    aimed.hit = hit;
    tracer_.apply_textures(aimed, source.patterns, context_);
    return source.radiance * aimed.pattern;
}

/// Radiance of any source, and how far its surface is.
DirectCalculation::Emission DirectCalculation::traced_emission(std::int32_t source,
                                                               const Vec3& direction) const {
    Ray aimed = aimed_ray(source, direction);
    tracer_.trace(aimed, context_);
    return {aimed.value, aimed.hit.t};
}

/// Contributions of the candidates among [first, last) in this state, which is one of those whose
/// contribution is not known. Sources with the same patterns are evaluated side by side: windows
/// under one sky are most of what an interior sees.
void DirectCalculation::find_radiances(std::size_t first, std::size_t last, CandidateState state) {
    std::array<std::size_t, kLanes> group{};
    std::size_t size = 0;
    ModifierId patterns = kVoid;
    const auto finish = [&] {
        if (size == 1) find_radiance(group[0]);
        if (size > 1) find_radiances(std::span(group).first(size), patterns);
        size = 0;
    };
    for (std::size_t i = first_candidate_ + first; i < first_candidate_ + last; ++i) {
        const LightCandidate& candidate = scratch_.candidates[i];
        if (candidate.state != state) continue;
        const LightSource& source = lights_[candidate.source];
        if (!source.side_by_side || !in_clear_air()) {
            find_radiance(i);
            continue;
        }
        if (size == kLanes || source.patterns != patterns) finish();
        patterns = source.patterns;
        group[size++] = i;
    }
    finish();
}

/// The same for up to kLanes candidates whose sources have the same patterns.
void DirectCalculation::find_radiances(std::span<const std::size_t> group, ModifierId patterns) {
    std::array<RayHit, kLanes> hits;
    std::array<std::size_t, kLanes> which{};
    std::size_t size = 0;
    for (const std::size_t i : group) {
        const LightCandidate& candidate = scratch_.candidates[i];
        if (meet(candidate, hits[size].hit)) {
            hits[size].direction = candidate.direction;
            which[size++] = i;
        } else {
            set_radiance(i, {});
        }
    }
    if (size == 0) return;
    std::array<float, kLanes> pattern;
    pattern.fill(1);
    for (ModifierId m = patterns; m != kVoid; m = tracer_.scene().modifier(m).next) {
        const FunctionBinding* function = tracer_.scene().modifier(m).node->brightness_function();
        const auto values = function->evaluate_lanes(aimed_, std::span(hits).first(size), context_);
        if (!values) {
            for (std::size_t k = 0; k < size; ++k) find_radiance(which[k]);
            return;
        }
        for (std::size_t k = 0; k < size; ++k) pattern[k] *= static_cast<float>(values->value[k]);
    }
    for (std::size_t k = 0; k < size; ++k) {
        const std::int32_t source = scratch_.candidates[which[k]].source;
        set_radiance(which[k], lights_[source].radiance * pattern[k]);
    }
}

void DirectCalculation::find_radiance(std::size_t i) {
    const LightCandidate candidate = scratch_.candidates[i];  // tracing may move them
    set_radiance(i, emission(candidate));
}

/// The contribution of a candidate, its source's radiance known.
void DirectCalculation::set_radiance(std::size_t i, const Rgb& radiance) {
    LightCandidate& candidate = scratch_.candidates[i];
    candidate.contribution = candidate.coefficient * radiance;
    candidate.brightness = brightness(candidate.contribution);
    if (!brings_light(candidate.brightness))
        set_dark(candidate);
    else
        candidate.state = candidate.state == CandidateState::unknown ? CandidateState::known
                                                                     : CandidateState::lit;
}

}  // namespace lightwalk
