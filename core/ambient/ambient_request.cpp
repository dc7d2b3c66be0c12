#include "core/ambient/ambient_request.h"

#include <bit>

namespace lightwalk {

RandomStream stream_of(const AmbientQuery& query, std::uint64_t seed) {
    std::uint64_t key = mix_bits(seed + static_cast<std::uint64_t>(query.level));
    for (const Vec3& v : {query.position, query.normal}) {
        for (std::size_t k = 0; k < 3; ++k)
            key = mix_bits(key ^ std::bit_cast<std::uint64_t>(v[k]));
    }
    return RandomStream(key);
}

bool can_stand_alone(const Ray& ray) {
    return ray.clip == nullptr && ray.next_clip == nullptr && ray.medium.scatter == nullptr &&
           !ray.aimed;
}

AmbientPoint point_of(const AmbientRequest& request) {
    const Ray& ray = request.ray;
    AmbientPoint point;
    point.query = request.query;
    point.far_side = request.far_side;
    point.distance = ray.hit.t;
    point.path_length = ray.path_length;
    point.limit = ray.limit;
    point.ray_level = ray.level;
    point.history = ray.history;
    point.target = ray.target;
    point.medium = ray.medium;
    return point;
}

Ray ray_to(const AmbientPoint& point) {
    Ray ray;
    ray.coef =
        Rgb::grey(1 / kAssumedReflectance);  // the terms of its hemisphere are those of the value
    ray.hit.t = point.distance;
    ray.hit.position = point.query.position;
    ray.hit.normal = point.far_side ? -point.query.normal : point.query.normal;
    ray.limit = point.limit;
    ray.weight = point.query.weight;
    ray.level = point.ray_level;
    ray.history = point.history;
    ray.target = point.target;
    ray.medium = point.medium;
    ray.path_length = point.path_length;
    return ray;
}

}  // namespace lightwalk
