#include "core/trace/trace_rays.h"

#include "core/math/distance.h"

namespace lightwalk {
namespace {

/// The hit reported for a ray without direction, or that meets nothing.
void set_missed(Ray& ray) {
    ray.hit = Hit{};
    ray.hit.position = ray.limit > 0 ? ray.origin + ray.limit * ray.direction : ray.origin;
}

void trace_one(const Tracer& tracer, const RayQuery& query, RandomStream random,
               const RayListOptions& options, TraceContext& context, std::size_t index,
               TakeRay take) {
    const double size = length(query.direction);
    if (!(size > 0)) {
        Ray ray = tracer.primary(query.origin, query.direction, 0, random);
        set_missed(ray);
        return take(index, ray, ray.hit);
    }
    if (options.sensor) {
        const Ray ray = tracer.irradiance(query.origin, query.direction, random, context);
        return take(index, ray, ray.hit);
    }
    Ray ray =
        tracer.primary(query.origin, query.direction, options.limit_by_length ? size : 0, random);
    const double farthest = farthest_hit(ray.limit);
    const Hit first = tracer.scene().geometry().intersect({ray.origin, ray.direction, farthest});
    if (options.shade) {
        tracer.shade_hit(ray, first, context);
    } else {
        ray.hit = first;
        ++context.counters.rays.primary;
    }
    if (!ray.hit.exists()) set_missed(ray);
    take(index, ray, first);
}

}  // namespace

void trace_rays(const Tracer& tracer, TraceContext& context, std::span<const RayQuery> queries,
                std::uint64_t first_index, const RayListOptions& options, TakeRay take) {
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const std::uint64_t number = first_index + i;
        const RandomStream random =
            RandomStream::of_pixel(options.seed, static_cast<std::uint32_t>(number),
                                   static_cast<std::uint32_t>(number >> 32), 0);
        trace_one(tracer, queries[i], random, options, context, i, take);
    }
}

}  // namespace lightwalk
