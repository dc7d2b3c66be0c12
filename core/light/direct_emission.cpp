// What light sources send towards a point, when nothing else is in the scene.
#include <algorithm>
#include <cmath>
#include <span>

#include "core/geometry/polygon.h"
#include "core/light/direct_calculation.h"

namespace lightwalk {

bool brings_light(float brightness) {
    return brightness > 0 && std::isfinite(brightness);
}

/// A ray from the point that sees the source and nothing else.
Ray DirectCalculation::aimed_ray(const ShadingPoint& point, std::int32_t source,
                                 const Vec3& direction) const {
    Ray& parent = *point.ray;
    const RandomStream before = parent.random;
    Ray ray;
    (void)tracer_.spawn(ray, kShadow, parent, nullptr);
    parent.random = before;  // which gave what was due when the point was begun
    ray.aimed = true;
    ray.direction = direction;
    ray.target = source;
    ray.random = point.start.random;
    return ray;
}

/// Where a candidate's direction meets the front of its source; false: it misses. On polygons the
/// distance is known already, and only the outline remains to be asked.
bool DirectCalculation::meet(const LightCandidate& candidate, Hit& hit) const {
    const LightSource& source = lights_[candidate.source];
    const ShadingPoint& point = point_of(candidate);
    const Vec3& direction = candidate.direction;
    const double t = candidate.distance;
    const auto* polygon =
        source.is_distant() ? nullptr : std::get_if<PolygonShape>(&lights_.shape(candidate.source));
    if (!polygon || polygon->vertices.size() > kLargePolygon) {  // those have an index of their own
        Ray aimed = aimed_ray(point, candidate.source, direction);
        if (!lights_.intersect_target(aimed, tracer_) || aimed.hit.cos_out < 0) return false;
        hit = aimed.hit;
        return true;
    }
    const Vec3& origin = point.position;
    if (!contains(*polygon, origin + direction * t, nullptr)) return false;
    hit = Hit{};
    hit.t = t;
    hit.position = fused_advance(origin, direction, t);
    hit.normal = polygon->normal;
    hit.cos_out = -fused_dot(direction, hit.normal);
    hit.surface = source.object;
    hit.modifier = tracer_.scene().surface(source.object).modifier();
    return true;
}

/// Radiance of the real source of a candidate. For plain ones the ray's way through materials is
/// cut short.
Rgb DirectCalculation::emission(const LightCandidate& candidate) const {
    const LightSource& source = lights_[candidate.source];
    const ShadingPoint& point = point_of(candidate);
    if (!source.plain || !point.clear_air)
        return traced_emission(point, candidate.source, candidate.direction).radiance;
    Hit hit;
    if (!meet(candidate, hit)) return {};
    Ray aimed = aimed_ray(point, candidate.source, candidate.direction);
    aimed.hit = hit;
    tracer_.apply_textures(aimed, source.patterns, context_);
    return source.radiance * aimed.pattern;
}

/// Radiance of any source, and how far its surface is.
DirectCalculation::Emission DirectCalculation::traced_emission(const ShadingPoint& point,
                                                               std::int32_t source,
                                                               const Vec3& direction) const {
    Ray aimed = aimed_ray(point, source, direction);
    tracer_.trace(aimed, context_);
    return {aimed.value, aimed.hit.t};
}

/// Contributions of the candidates in this state, which is one of those whose contribution is not
/// known. Sources with the same patterns are evaluated side by side: windows under one sky are most
/// of what an interior sees.
void DirectCalculation::find_radiances(std::span<const std::uint32_t> candidates,
                                       CandidateState state) {
    std::vector<std::uint32_t>& lanes = scratch_.patterns.candidates;
    lanes.clear();
    const bool together = tracer_.options().ablation.function_lanes;
    for (const std::uint32_t i : candidates) {
        LightCandidate& candidate = scratch_.candidates[i];
        if (candidate.state != state) continue;
        if (together && lights_[candidate.source].has_lanes && point_of(candidate).clear_air)
            lanes.push_back(i);
        else
            find_radiance(candidate);
    }
    const auto patterns = [&](std::uint32_t i) {
        return lights_[scratch_.candidates[i].source].patterns;
    };
    const auto by_patterns = [&](std::uint32_t a, std::uint32_t b) {
        return index(patterns(a)) < index(patterns(b));
    };
    if (!std::is_sorted(lanes.begin(), lanes.end(), by_patterns))
        std::sort(lanes.begin(), lanes.end(), by_patterns);
    for (std::size_t first = 0; first < lanes.size();) {
        std::size_t last = first + 1;
        while (last < lanes.size() && last < first + kSideBySide &&
               patterns(lanes[last]) == patterns(lanes[first]))
            ++last;
        find_side_by_side(std::span(lanes).subspan(first, last - first), patterns(lanes[first]));
        first = last;
    }
}

/// The same for up to kSideBySide candidates whose sources have the same patterns.
void DirectCalculation::find_side_by_side(std::span<const std::uint32_t> group,
                                          ModifierId patterns) {
    PatternScratch& g = scratch_.patterns;
    std::size_t size = 0;
    for (const std::uint32_t i : group) {
        LightCandidate& candidate = scratch_.candidates[i];
        if (meet(candidate, g.hits[size].hit)) {
            const ShadowStart& start = point_of(candidate).start;
            g.hits[size].way = {candidate.direction, start.path_length, start.shadow_length};
            g.pattern[size] = 1.0f;
            g.which[size++] = i;
        } else {
            set_radiance(candidate, {});
        }
    }
    const auto hits = std::span(g.hits).first(size);
    for (ModifierId m = patterns; m != kVoid; m = tracer_.scene().modifier(m).next) {
        const FunctionBinding* function = tracer_.scene().modifier(m).node->brightness_function();
        function->evaluate_all(hits, g.values, context_);
        for (std::size_t k = 0; k < size; ++k) {
            if (g.pattern[k] && g.values[k])
                *g.pattern[k] *= static_cast<float>(*g.values[k]);
            else
                g.pattern[k].reset();
        }
    }
    for (std::size_t k = 0; k < size; ++k) {
        LightCandidate& candidate = scratch_.candidates[g.which[k]];
        if (g.pattern[k])
            set_radiance(candidate, lights_[candidate.source].radiance * *g.pattern[k]);
        else
            find_radiance(candidate);
    }
}

void DirectCalculation::find_radiance(LightCandidate& candidate) {
    set_radiance(candidate, emission(candidate));
}

/// The contribution of a candidate, its source's radiance known.
void DirectCalculation::set_radiance(LightCandidate& candidate, const Rgb& radiance) {
    candidate.contribution = candidate.coefficient * radiance;
    candidate.brightness = brightness(candidate.contribution);
    if (!brings_light(candidate.brightness)) {
        candidate.state = CandidateState::dark;
        candidate.contribution = Rgb{};
    } else {
        candidate.state = candidate.state == CandidateState::unknown ? CandidateState::known
                                                                     : CandidateState::lit;
    }
}

}  // namespace lightwalk
