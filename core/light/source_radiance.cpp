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

/// Where a lazy candidate's direction meets the front of its source; false: it misses. On polygons
/// the distance is known already, and only the outline remains to be asked.
bool DirectCalculation::meet(const LightCandidate& candidate, Hit& hit) {
    const LightSource& source = lights_[candidate.source];
    const Surface& surface = tracer_.scene().surface(source.object);
    const Vec3& direction = candidate.direction;
    const double t = candidate.distance;
    const auto* polygon = source.distant ? nullptr : std::get_if<PolygonShape>(&surface.shape);
    if (!polygon || polygon->vertices.size() > kLargePolygon) {  // those have an index of their own
        aimed_.direction = direction;
        aimed_.target = candidate.source;
        if (!lights_.intersect_target(aimed_, tracer_) || aimed_.hit.rod < 0) return false;
        hit = aimed_.hit;
        return true;
    }
    if (!contains(*polygon, aimed_.origin + direction * t, nullptr)) return false;
    hit = Hit{};
    hit.t = t;
    hit.position = fused_advance(aimed_.origin, direction, t);
    hit.normal = polygon->normal;
    hit.rod = -fused_dot(direction, hit.normal);
    hit.surface = source.object;
    hit.modifier = surface.modifier;
    return true;
}

/// Radiance of the real source of a lazy candidate. For plain ones the ray's way through materials
/// is cut short.
Rgb DirectCalculation::emission(const LightCandidate& candidate) {
    const LightSource& source = lights_[candidate.source];
    if (!source.plain || !in_clear_air())
        return traced_emission(candidate.source, candidate.direction).radiance;
    Hit hit;
    if (!meet(candidate, hit)) return {};
    const RandomStream random = aimed_.random;
    aimed_.direction = candidate.direction;
    aimed_.target = candidate.source;
    aimed_.hit = hit;
    aimed_.pattern = {1, 1, 1};
    tracer_.apply_textures(aimed_, source.patterns, context_);
    aimed_.random = random;
    return source.radiance * aimed_.pattern;
}

/// Radiance of any source, and how far its surface is.
DirectCalculation::Emission DirectCalculation::traced_emission(std::int32_t source,
                                                               const Vec3& direction) {
    const RandomStream random = aimed_.random;
    const Medium medium = aimed_.medium;  // a dielectric would change it
    aimed_.direction = direction;
    aimed_.target = source;
    aimed_.coef = aimed_.pattern = {1, 1, 1};
    aimed_.value = aimed_.mirrored = {};
    tracer_.trace(aimed_, context_);
    aimed_.random = random;
    aimed_.medium = medium;
    return {aimed_.value, aimed_.hit.t};
}

/// Contributions of the lazy candidates among [first, last) that are visible. Sources with the same
/// patterns are evaluated side by side: windows under one sky are most of what an interior sees.
void DirectCalculation::find_radiances(std::size_t first, std::size_t last) {
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
        if (!candidate.visible || !candidate.lazy) continue;
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

/// The contribution of a lazy candidate, its source's radiance known.
void DirectCalculation::set_radiance(std::size_t i, const Rgb& radiance) {
    LightCandidate& candidate = scratch_.candidates[i];
    candidate.contribution = candidate.coefficient * radiance;
    candidate.brightness = brightness(candidate.contribution);
    candidate.lazy = false;
    candidate.visible = brings_light(candidate.brightness);
}

}  // namespace lightwalk
