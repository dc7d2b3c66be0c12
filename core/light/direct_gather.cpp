// The first stage of the direct calculation: which samples of which sources could light a point.
#include <cmath>
#include <utility>

#include "core/geometry/polygon.h"
#include "core/light/direct_calculation.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLate = 4096;  ///< points after which half of what was is forgotten

}  // namespace

LitPoint::LitPoint(const DirectRequest& request)
    : position(request.ray->hit.position),
      one_sided(request.front != nullptr),
      coefficient(request.coefficient),
      ray(request.ray),
      start(Tracer::start_shadow(*request.ray)) {
    if (one_sided) front = *request.front;
    clear_air = max_component(ray->medium.extinction) <= 1e-10f;
    clipped = ray->clip || ray->next_clip;
    limited = ray->limit > kEpsilon && ray->limit - ray->hit.t > kEpsilon;
}

void DirectCalculation::gather(std::span<const DirectRequest> requests) {
    for (const DirectRequest& request : requests) {
        LitPoint& point = scratch_.points.emplace_back(request);
        point.part_size = partition_size(tracer_.options().source_subdivision, point.start.weight);
    }
    SourcePlaces& places = scratch_.places;
    for (const std::int32_t source : lights_.sampled()) {
        find_places(source);
        if (places.size() == 0) continue;
        places.sample(lights_[source]);
        const PolygonShape* polygon = polygon_of(lights_[source]);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (const auto sample = places[i]) consider(places.number(i), source, polygon, *sample);
        }
    }
    number_candidates();
    shared_.points += scratch_.points.size();
    shared_.candidates += scratch_.candidates.size();
    if (shared_.points > kLate) {
        shared_.points /= 2;
        shared_.candidates /= 2;
    }
}

/// Where the points look at a source.
void DirectCalculation::find_places(std::int32_t index) {
    const LightSource& source = lights_[index];
    const double jitter = tracer_.options().source_jitter;
    const Partition divide(source);
    scratch_.places.clear();
    for (std::size_t number = 0; number < scratch_.points.size(); ++number) {
        LitPoint& point = scratch_.points[number];
        if (out_of_reach(source, point.position)) continue;
        if (point.one_sided && is_behind(source, point.position, point.front)) continue;
        divide(point.position, point.part_size, scratch_.parts);
        const int parts = scratch_.parts.count;
        for (int i = 0; i < parts; ++i) {
            const SourcePart& part = scratch_.parts.part[static_cast<std::size_t>(i)];
            scratch_.places.add(source, part, parts, point.position,
                                static_cast<std::uint32_t>(number), jitter, point.start.random);
        }
    }
}

/// Candidates were found source by source: bring those of each point together.
void DirectCalculation::number_candidates() {
    for (const LightCandidate& candidate : scratch_.candidates)
        ++scratch_.points[candidate.point].count;
    std::size_t first = 0;
    for (LitPoint& point : scratch_.points) {
        point.first = first;
        first += std::exchange(point.count, 0);
    }
    scratch_.ranks.resize(first);
    for (std::size_t i = 0; i < first; ++i) {
        LitPoint& point = scratch_.points[scratch_.candidates[i].point];
        scratch_.ranks[point.first + point.count++] = static_cast<std::uint32_t>(i);
    }
}

/// The outline of a local polygon.
const PolygonShape* DirectCalculation::polygon_of(const LightSource& source) const {
    return source.distant
               ? nullptr
               : std::get_if<PolygonShape>(&tracer_.scene().surface(source.object).shape);
}

/// Make a candidate of a sample that can bring light.
void DirectCalculation::consider(std::uint32_t number, std::int32_t index,
                                 const PolygonShape* polygon, const SourceSample& sample) {
    const LightSource& source = lights_[index];
    const LitPoint& point = scratch_.points[number];
    if (source.is_virtual && !meets_relay(source, sample, point.position)) return;
    const Rgb k = point.coefficient(sample.direction, sample.solid_angle);
    if (!(max_component(k) > 0)) return;
    if (is_constant(source) && point.clear_air) {
        if (const auto distance = front_distance(source, point.position, sample.direction))
            add_candidate(number, index, sample, k, {source.radiance, *distance});
    } else if (!source.is_virtual && !needs_tracing(source, point)) {
        const auto distance = polygon ? plane_distance(*polygon, point.position, sample.direction)
                                      : front_distance(source, point.position, sample.direction);
        if (distance) add_unknown(number, index, sample, k, *distance);
    } else {
        add_candidate(number, index, sample, k, traced_emission(point, index, sample.direction));
    }
}

/// A candidate whose radiance is not known yet.
void DirectCalculation::add_unknown(std::uint32_t point, std::int32_t source,
                                    const SourceSample& sample, const Rgb& coefficient,
                                    double distance) {
    scratch_.candidates.push_back({source,
                                   point,
                                   sample.direction,
                                   distance,
                                   coefficient,
                                   {},
                                   0,
                                   CandidateState::unknown,
                                   false});
}

/// Unless nothing arrives.
void DirectCalculation::add_candidate(std::uint32_t point, std::int32_t source,
                                      const SourceSample& sample, const Rgb& coefficient,
                                      const Emission& emitted) {
    const Rgb contribution = coefficient * emitted.radiance;
    const float b = brightness(contribution);
    if (!brings_light(b)) return;
    scratch_.candidates.push_back({source, point, sample.direction, emitted.distance, coefficient,
                                   contribution, b, CandidateState::known, false});
}

/// Most samples of a virtual source pass its mirror by: the outline says so before a ray is traced.
bool DirectCalculation::meets_relay(const LightSource& source, const SourceSample& sample,
                                    const Vec3& origin) const {
    return tracer_.scene()
        .geometry()
        .intersect_surface(source.object, {origin, sample.direction, kHuge})
        .exists();
}

/// Whether a source has no patterns: in clear air its radiance is its material's colour where a ray
/// meets its front.
bool DirectCalculation::is_constant(const LightSource& source) {
    return source.uniform && !source.is_virtual;
}

/// How far the front of a source is; nothing when the direction misses it or meets its back.
std::optional<double> DirectCalculation::front_distance(const LightSource& source,
                                                        const Vec3& origin,
                                                        const Vec3& direction) const {
    if (source.distant) {
        const bool inside =
            2 * kPi * (1 - dot(source.center, direction)) <= static_cast<double>(source.size);
        return inside ? std::optional(kHuge) : std::nullopt;
    }
    const Surface& surface = tracer_.scene().surface(source.object);
    const auto hit = intersect(surface.shape, origin, direction, kHuge);
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
