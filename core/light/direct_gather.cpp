// The first stage of the direct calculation: which samples of which sources could light a point.
#include <cmath>
#include <numeric>

#include "core/geometry/polygon.h"
#include "core/light/direct_calculation.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLate = 4096;  ///< points after which half of what was is forgotten

}  // namespace

ShadingPoint::ShadingPoint(const DirectRequest& request)
    : position(request.ray->hit.position),
      one_sided(request.front != nullptr),
      coefficient(request.coefficient),
      ray(request.ray),
      account(request.account),
      start(LightTransport::start_shadow(*request.ray)) {
    if (one_sided) front = *request.front;
    clear_air = max_component(ray->medium.extinction) <= 1e-10f;
    clipped = ray->clip || ray->next_clip;
    limited = is_limited(ray->limit) && is_limited(ray->limit - ray->hit.t);
}

void DirectCalculation::gather(std::span<const DirectRequest> requests) {
    for (const DirectRequest& request : requests) {
        ShadingPoint& point = scratch_.points.emplace_back(request);
        point.part_size = partition_size(tracer_.options().source_subdivision, point.start.weight);
        point.chosen = wanted_lights(point) > 0;
        point.sampled = point.chosen && !point.ray->in(kAmbient);
    }
    for (std::uint32_t number = 0; number < scratch_.points.size(); ++number) {
        ShadingPoint& point = scratch_.points[number];
        point.first = scratch_.candidates.size();
        find_samples(point);
        consider_samples(number);
        point.count = scratch_.candidates.size() - point.first;
    }
    scratch_.ranks.resize(scratch_.candidates.size());
    std::iota(scratch_.ranks.begin(), scratch_.ranks.end(), 0U);
    shared_.points += scratch_.points.size();
    shared_.candidates += scratch_.candidates.size();
    if (shared_.points > kLate) {
        shared_.points /= 2;
        shared_.candidates /= 2;
    }
}

/// What a point sees of all sources, as far as these alone can tell.
void DirectCalculation::find_samples(ShadingPoint& point) {
    lights_.boxes().look(point.position, point.one_sided ? &point.front : nullptr, point.part_size,
                         scratch_.gather.views);
    scratch_.gather.samples.clear();
    for (const std::uint32_t k : point.chosen ? choose_sources(point) : lights_.each())
        add_source(point, k);
    scratch_.gather.samples.sample(lights_.all(), point.position,
                                   tracer_.options().ablation.sample_lanes);
    if (lights_.virtual_count() == 0) return;
    scratch_.gather.samples.retain([&](std::size_t i) {
        const LightSource& source = lights_[scratch_.gather.samples.source(i)];
        return !source.is_virtual() ||
               meets_redirecting_surface(source, point.position,
                                         scratch_.gather.samples.lights().direction(i));
    });
}

/// The samples of one of the sampled sources.
void DirectCalculation::add_source(ShadingPoint& point, std::size_t k) {
    const double jitter = tracer_.options().source_jitter;
    const bool divided = point.part_size > 0;
    const SourceViews& views = scratch_.gather.views;
    if (point.one_sided && views.is_behind(k)) return;
    if (divided && views.turns_away(k)) return;
    const std::int32_t index = lights_.sampled()[k];
    const LightSource& source = lights_[index];
    if (out_of_reach(source, point.position)) return;
    if ((!divided || views.is_far(k)) && !(jitter > 0)) {
        lights_.boxes().add_whole(k, index, views, scratch_.gather.samples);
        return;
    }
    Partition{source}(point.position, point.part_size, scratch_.gather.parts);
    const int parts = scratch_.gather.parts.count;
    for (int i = 0; i < parts; ++i) {
        const SourcePart& part = scratch_.gather.parts.part[static_cast<std::size_t>(i)];
        scratch_.gather.samples.add(source, index, part, parts, point.position, jitter,
                                    point.start.random);
    }
}

/// Candidates of the samples that the surface sends on.
void DirectCalculation::consider_samples(std::uint32_t number) {
    const ShadingPoint& point = scratch_.points[number];
    const LightSamples lights = scratch_.gather.samples.lights();
    if (lights.count == 0) return;
    if (scratch_.gather.coefficients.size() < lights.count)
        scratch_.gather.coefficients.resize(lights.count);
    const std::span k = std::span(scratch_.gather.coefficients).first(lights.count);
    if (tracer_.options().ablation.sample_lanes) {
        point.coefficient(lights, k);
    } else {
        for (std::size_t i = 0; i < lights.count; ++i)
            point.coefficient(lights.single(i), k.subspan(i, 1));
    }
    std::int32_t last = -1;
    const PolygonShape* polygon = nullptr;
    for (std::size_t i = 0; i < lights.count; ++i) {
        if (!(max_component(k[i]) > 0)) continue;
        const std::int32_t source = scratch_.gather.samples.source(i);
        if (point.chosen) k[i] *= scratch_.choice.scales[static_cast<std::size_t>(source)];
        if (source != last) polygon = polygon_of(source);
        last = source;
        consider(number, source, polygon, lights.direction(i), k[i]);
    }
}

/// The outline of a local polygon.
const PolygonShape* DirectCalculation::polygon_of(std::int32_t source) const {
    return lights_[source].is_distant() ? nullptr
                                        : std::get_if<PolygonShape>(&lights_.shape(source));
}

/// Make a candidate of a sample that can bring light, of which the surface sends on `k`.
void DirectCalculation::consider(std::uint32_t number, std::int32_t index,
                                 const PolygonShape* polygon, const Vec3& direction, const Rgb& k) {
    const LightSource& source = lights_[index];
    const ShadingPoint& point = scratch_.points[number];
    if (is_constant(source) && point.clear_air) {
        if (const auto distance = front_distance(index, point.position, direction))
            add_candidate(number, index, direction, k, {source.radiance, *distance});
    } else if (!source.is_virtual() && !needs_tracing(source, point)) {
        const auto distance = polygon ? plane_distance(*polygon, point.position, direction)
                                      : front_distance(index, point.position, direction);
        if (distance) add_unknown(number, index, direction, k, *distance);
    } else {
        add_candidate(number, index, direction, k, traced_emission(point, index, direction));
    }
}

/// A candidate whose radiance is not known yet.
void DirectCalculation::add_unknown(std::uint32_t point, std::int32_t source, const Vec3& direction,
                                    const Rgb& coefficient, double distance) {
    LightCandidate& candidate = scratch_.candidates.emplace_back();
    candidate.source = source;
    candidate.point = point;
    candidate.direction = direction;
    candidate.distance = distance;
    candidate.coefficient = coefficient;
}

/// Unless nothing arrives.
void DirectCalculation::add_candidate(std::uint32_t point, std::int32_t source,
                                      const Vec3& direction, const Rgb& coefficient,
                                      const Emission& emitted) {
    const Rgb contribution = coefficient * emitted.radiance;
    const float b = brightness(contribution);
    if (!brings_light(b)) return;
    add_unknown(point, source, direction, coefficient, emitted.distance);
    LightCandidate& candidate = scratch_.candidates.back();
    candidate.contribution = contribution;
    candidate.brightness = b;
    candidate.state = CandidateState::known;
}

/// Most samples of a virtual source pass its mirror by: the outline says so before a ray is traced.
bool DirectCalculation::meets_redirecting_surface(const LightSource& source, const Vec3& origin,
                                                  const Vec3& direction) const {
    return tracer_.scene()
        .geometry()
        .intersect_surface(source.object, {origin, direction, kHuge})
        .exists();
}

/// Whether a source has no patterns: in clear air its radiance is its material's colour where a ray
/// meets its front.
bool DirectCalculation::is_constant(const LightSource& source) {
    return source.uniform && !source.is_virtual();
}

/// How far the front of a source is; nothing when the direction misses it or meets its back.
std::optional<double> DirectCalculation::front_distance(std::int32_t number, const Vec3& origin,
                                                        const Vec3& direction) const {
    const LightSource& source = lights_[number];
    if (source.is_distant()) {
        const bool inside =
            2 * kPi * (1 - dot(source.center, direction)) <= static_cast<double>(source.size);
        return inside ? std::optional(kHuge) : std::nullopt;
    }
    const auto hit = intersect(lights_.shape(number), origin, direction, kHuge);
    if (!hit || dot(hit->normal, direction) > 0) return std::nullopt;
    return hit->t;
}

/// The same for polygons without asking whether the direction meets the outline: traced_emission
/// does, where it matters.
std::optional<double> DirectCalculation::plane_distance(const PolygonShape& polygon,
                                                        const Vec3& origin, const Vec3& direction) {
    const double cosine = fused_dot(polygon.normal, direction);
    if (!(cosine < -kEpsilon)) return std::nullopt;
    const double t = (polygon.offset - fused_dot(polygon.normal, origin)) / cosine;
    return t > kEpsilon ? std::optional(t) : std::nullopt;
}

}  // namespace lightwalk
