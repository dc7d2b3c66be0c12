#include "core/geometry/embree_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/geometry/bounds.h"

namespace lightwalk {
namespace {

constexpr unsigned kFewRays =
    4;  ///< up to so many rays of a packet that reach an instance are traced singly

/// Boxes are clamped to this [m]: rays reach 1e10 m, and Embree needs coordinates below 1.8e18 even
/// after the inverse of an instance.
constexpr double kFarthest = 4e10;
float round_down(double x) {
    const auto f = static_cast<float>(std::clamp(x, -kFarthest, kFarthest));
    return std::nextafter(f, -std::numeric_limits<float>::infinity());
}
float round_up(double x) {
    return -round_down(-x);
}

/// The ray of a lane, in the model's space. The direction is not normalised, so that distances stay
/// those of the world.
RTCRay local_ray(const Instance& instance, RTCRayN* rays, unsigned count, unsigned lane) {
    const std::array<float, 12>& m = instance.inverse;
    const float x = RTCRayN_org_x(rays, count, lane), y = RTCRayN_org_y(rays, count, lane),
                z = RTCRayN_org_z(rays, count, lane);
    const float u = RTCRayN_dir_x(rays, count, lane), v = RTCRayN_dir_y(rays, count, lane),
                w = RTCRayN_dir_z(rays, count, lane);
    RTCRay ray;
    ray.org_x = m[0] * x + m[3] * y + m[6] * z + m[9];
    ray.org_y = m[1] * x + m[4] * y + m[7] * z + m[10];
    ray.org_z = m[2] * x + m[5] * y + m[8] * z + m[11];
    ray.dir_x = m[0] * u + m[3] * v + m[6] * w;
    ray.dir_y = m[1] * u + m[4] * v + m[7] * w;
    ray.dir_z = m[2] * u + m[5] * v + m[8] * w;
    ray.tnear = 0;
    ray.time = 0;
    ray.tfar = RTCRayN_tfar(rays, count, lane);
    ray.mask = ~0U;
    ray.id = RTCRayN_id(rays, count, lane);
    ray.flags = 0;
    return ray;
}

void set_lane(RTCRay16& rays, unsigned lane, const RTCRay& ray) {
    rays.org_x[lane] = ray.org_x;
    rays.org_y[lane] = ray.org_y;
    rays.org_z[lane] = ray.org_z;
    rays.tnear[lane] = ray.tnear;
    rays.dir_x[lane] = ray.dir_x;
    rays.dir_y[lane] = ray.dir_y;
    rays.dir_z[lane] = ray.dir_z;
    rays.time[lane] = ray.time;
    rays.tfar[lane] = ray.tfar;
    rays.mask[lane] = ray.mask;
    rays.id[lane] = ray.id;
    rays.flags[lane] = ray.flags;
}

}  // namespace

/// Sets, for its lifetime, the instance whose model is searched (Query::within).
class InstanceScope {
  public:
    InstanceScope(RTCIntersectContext& context, const Instance& instance)
        : query_(static_cast<Query&>(context)),
          instance_(instance),
          outside_(query_.within),
          id_{(outside_ ? index(outside_->id_) : index(kWorld)) + instance.first} {
        query_.within = this;
    }
    ~InstanceScope() { query_.within = outside_; }
    InstanceScope(const InstanceScope&) = delete;
    InstanceScope& operator=(const InstanceScope&) = delete;

    [[nodiscard]] InstanceId id() const { return id_; }
    /// Computed at the first call: in most instances that are searched no primitive is tested.
    [[nodiscard]] const InnerSpace& space() {
        if (!space_)
            space_ = space_in(outside_ ? &outside_->space() : nullptr, *instance_.placement);
        return *space_;
    }

  private:
    Query& query_;
    const Instance& instance_;
    InstanceScope* outside_;
    InstanceId id_;
    std::optional<InnerSpace> space_;
};

namespace {

InstanceId instance_of(const Query& query) {
    return query.within ? query.within->id() : kWorld;
}

/// Transforms the ray into the present instance, before one of its primitives is proposed.
void enter(const Query& query, TracedRay& ray, InstanceId id) {
    if (query.within && ray.local_instance != id)
        PlacedScene::enter(ray, id, query.within->space());
}

LeafRay leaf_ray(RTCRayN* rays, unsigned count, unsigned lane) {
    return {{RTCRayN_org_x(rays, count, lane), RTCRayN_org_y(rays, count, lane),
             RTCRayN_org_z(rays, count, lane)},
            {RTCRayN_dir_x(rays, count, lane), RTCRayN_dir_y(rays, count, lane),
             RTCRayN_dir_z(rays, count, lane)}};
}

unsigned active_lanes(const int* valid, unsigned count) {
    return static_cast<unsigned>(std::count_if(valid, valid + count, [](int v) { return v != 0; }));
}

}  // namespace

void close_lanes(RTCRayHit16& packet) {
    RTCRay closed{};
    closed.tnear = 1;
    for (unsigned lane = 0; lane < kPacket; ++lane) {
        set_lane(packet.ray, lane, closed);
        packet.hit.geomID[lane] = packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

/// End of Embree's ray: nothing up to `limit` may be lost in rounding.
float embree_end(double limit, double start) {
    constexpr double kRoundUp = 1 + 0x1p-20;  // 16 half units in the last place
    return static_cast<float>(std::max(limit - start, 0.0) * kRoundUp);
}

RTCBounds rounded(const Bounds& box) {
    return {round_down(box.lower.x), round_down(box.lower.y), round_down(box.lower.z), 0,
            round_up(box.upper.x),   round_up(box.upper.y),   round_up(box.upper.z),   0};
}

Bounds bounds_of_tree(RTCSceneTy* scene) {
    RTCBounds b{};
    rtcGetSceneBounds(scene, &b);
    return {{static_cast<double>(b.lower_x), static_cast<double>(b.lower_y),
             static_cast<double>(b.lower_z)},
            {static_cast<double>(b.upper_x), static_cast<double>(b.upper_y),
             static_cast<double>(b.upper_z)}};
}

void primitive_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& model = *static_cast<const Hierarchy*>(args->geometryUserPtr);
    *args->bounds_o =
        rounded(model.space.box(model.bvh_primitives.box(args->primID, *model.primitives)));
}

// Flattened, as function calls inside callbacks cost as much as the tests themselves: rays are 3 %
// faster.
[[gnu::flatten]] void intersect_primitive(const RTCIntersectFunctionNArguments* args) {
    auto& query = *static_cast<NearestQuery*>(args->context);
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    const auto& model = *static_cast<const Hierarchy*>(args->geometryUserPtr);
    const InstanceId id = instance_of(query);
    const std::uint32_t first = model.bvh_primitives.primitive(args->primID),
                        end = first + model.bvh_primitives.count(args->primID);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        const unsigned i = RTCRayN_id(rays, args->N, lane);
        NearestRay& ray = query.rays[i];
        enter(query, ray, id);
        for (std::uint32_t primitive = first; primitive < end; ++primitive) {
            if (query.placed->propose(ray, {id, primitive}))
                RTCRayN_tfar(rays, args->N, lane) = embree_end(ray.limit, query.start[i]);
        }
    }
}

[[gnu::flatten]] void occlude_primitive(const RTCOccludedFunctionNArguments* args) {
    auto& query = *static_cast<ShadowQueries*>(args->context);
    const auto& model = *static_cast<const Hierarchy*>(args->geometryUserPtr);
    const InstanceId id = instance_of(query);
    const std::uint32_t first = model.bvh_primitives.primitive(args->primID),
                        end = first + model.bvh_primitives.count(args->primID);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        ShadowRay& ray = query.rays[RTCRayN_id(args->ray, args->N, lane)];
        enter(query, ray, id);
        for (std::uint32_t primitive = first; primitive < end; ++primitive) {
            if (query.placed->propose(ray, {id, primitive})) {
                RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
                break;
            }
        }
    }
}

void leaf_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& model = *static_cast<const Hierarchy*>(args->geometryUserPtr);
    *args->bounds_o = rounded(model.leaves[args->primID].box());
}

[[gnu::flatten]] void intersect_leaf(const RTCIntersectFunctionNArguments* args) {
    auto& query = *static_cast<NearestQuery*>(args->context);
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    const auto& model = *static_cast<const Hierarchy*>(args->geometryUserPtr);
    const QuantizedLeaf& leaf = model.leaves[args->primID];
    const InstanceId id = instance_of(query);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        float& end = RTCRayN_tfar(rays, args->N, lane);
        const LeafHits hits = boxes_met(leaf, leaf_ray(rays, args->N, lane), end);
        if (hits.met == 0) continue;
        const unsigned i = RTCRayN_id(rays, args->N, lane);
        NearestRay& ray = query.rays[i];
        enter(query, ray, id);
        for (std::uint32_t met = hits.met; met != 0; met &= met - 1) {
            const auto at = static_cast<std::size_t>(std::countr_zero(met));
            const PrimitiveRange bvh_primitive = leaf.bvh_primitives[at];
            if (bvh_primitive.is_none()) break;
            if (hits.first[at] > end * kEndRoundUp) continue;
            for (std::uint32_t primitive = bvh_primitive.first(); primitive < bvh_primitive.end();
                 ++primitive) {
                if (query.placed->propose(ray, {id, primitive}))
                    end = embree_end(ray.limit, query.start[i]);
            }
        }
    }
}

[[gnu::flatten]] void occlude_leaf(const RTCOccludedFunctionNArguments* args) {
    auto& query = *static_cast<ShadowQueries*>(args->context);
    const auto& model = *static_cast<const Hierarchy*>(args->geometryUserPtr);
    const QuantizedLeaf& leaf = model.leaves[args->primID];
    const InstanceId id = instance_of(query);
    const auto is_blocked = [&](ShadowRay& ray, std::uint32_t boxes) {
        enter(query, ray, id);
        for (; boxes != 0; boxes &= boxes - 1) {
            const PrimitiveRange bvh_primitive =
                leaf.bvh_primitives[static_cast<std::size_t>(std::countr_zero(boxes))];
            if (bvh_primitive.is_none()) return false;
            for (std::uint32_t primitive = bvh_primitive.first(); primitive < bvh_primitive.end();
                 ++primitive)
                if (query.placed->propose(ray, {id, primitive})) return true;
        }
        return false;
    };
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        float& end = RTCRayN_tfar(args->ray, args->N, lane);
        const std::uint32_t met = boxes_met(leaf, leaf_ray(args->ray, args->N, lane), end).met;
        if (met != 0 && is_blocked(query.rays[RTCRayN_id(args->ray, args->N, lane)], met))
            end = -std::numeric_limits<float>::infinity();
    }
}

void instance_bounds(const RTCBoundsFunctionArguments* args) {
    *args->bounds_o =
        rounded(static_cast<const Instances*>(args->geometryUserPtr)->boxes[args->primID]);
}

void intersect_instance(const RTCIntersectFunctionNArguments* args) {
    const Instance& instance =
        static_cast<const Instances*>(args->geometryUserPtr)->all[args->primID];
    const InstanceScope scope(*args->context, instance);
    const unsigned count = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, count);
    if (active_lanes(args->valid, count) <= kFewRays) {
        for (unsigned lane = 0; lane < count; ++lane) {
            if (args->valid[lane] == 0) continue;
            RTCRayHit hit;
            hit.ray = local_ray(instance, rays, count, lane);
            hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(instance.scene, args->context, &hit);
            RTCRayN_tfar(rays, count, lane) = hit.ray.tfar;
        }
        return;
    }
    alignas(64) std::array<int, kPacket> valid{};
    RTCRayHit16 hits;
    close_lanes(hits);
    for (unsigned lane = 0; lane < count; ++lane) {
        if (args->valid[lane] == 0) continue;
        valid[lane] = -1;
        set_lane(hits.ray, lane, local_ray(instance, rays, count, lane));
    }
    rtcIntersect16(valid.data(), instance.scene, args->context, &hits);
    for (unsigned lane = 0; lane < count; ++lane) {
        if (valid[lane] != 0) RTCRayN_tfar(rays, count, lane) = hits.ray.tfar[lane];
    }
}

void occlude_instance(const RTCOccludedFunctionNArguments* args) {
    const Instance& instance =
        static_cast<const Instances*>(args->geometryUserPtr)->all[args->primID];
    const InstanceScope scope(*args->context, instance);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        RTCRay ray = local_ray(instance, args->ray, args->N, lane);
        rtcOccluded1(instance.scene, args->context, &ray);
        RTCRayN_tfar(args->ray, args->N, lane) = ray.tfar;
    }
}

}  // namespace lightwalk
