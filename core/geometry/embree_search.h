#pragma once
// How Embree searches a placed scene: the records that it hands to the callbacks, and these.
#include <embree3/rtcore.h>

#include <array>
#include <memory>
#include <vector>

#include "core/geometry/bvh_primitives.h"
#include "core/geometry/placed_scene.h"
#include "core/geometry/quantized_leaves.h"
#include "core/geometry/search_space.h"

namespace lightwalk {

struct ReleaseScene {
    void operator()(RTCSceneTy* scene) const noexcept { rtcReleaseScene(scene); }
};
using ScenePtr = std::unique_ptr<RTCSceneTy, ReleaseScene>;

inline constexpr unsigned kPacket = 16;
inline constexpr unsigned kOwnSurfaces = 0, kInstances = 1;  ///< geometry ids in Embree's scenes

/// A model placed in another one, in whose search tree it is. An Embree instance would need half a
/// kilobyte, and would know no more than one level.
struct Instance {
    std::array<float, 12> inverse{};  ///< images of the axes and of the origin, into the model
    RTCSceneTy* scene = nullptr;
    const Placement* placement = nullptr;
    std::int32_t first = 0;  ///< see PlacedChild
};

struct Instances {
    std::vector<Instance> all;
    std::vector<Bounds> boxes;  ///< in the search coordinates, while the tree is built
};

/// A model in an Embree scene: its primitives, and the models placed in it.
struct Hierarchy {
    const ModelPrimitives* primitives = nullptr;
    SearchSpace space;
    // What Embree calls primitives: bvh primitives, their boxes only while the tree is built; or
    // leaves of them, which take their place.
    BvhPrimitives bvh_primitives;
    std::vector<QuantizedLeaf> leaves;
    Instances instances;
    ScenePtr scene;
    std::vector<Bounds> outline;  ///< of all in the tree, in the search coordinates; while trees
                                  ///< are built
};

class InstanceScope;

/// One traversal: what Embree hands to the callbacks.
struct Query : RTCIntersectContext {
    const PlacedScene* placed = nullptr;
    InstanceScope* within =
        nullptr;  ///< the placed model that the search is in; null: the scene itself
};
/// Ray i of a packet has the id i.
struct NearestQuery : Query {
    NearestRay* rays = nullptr;
    std::array<double, kPacket> start{};  ///< distance of Embree's origin from the true one [m]
};
struct ShadowQueries : Query {
    ShadowRay* rays = nullptr;
};

/// Make all rays of a packet ones that Embree skips: without AVX-512 it does not look at the mask
/// of valid lanes, only at whether a ray ends before it begins.
void close_lanes(RTCRayHit16& packet);

/// End of Embree's ray: nothing up to `limit` may be lost in rounding.
[[nodiscard]] float embree_end(double limit, double start);

/// The box in Embree's numbers, rounded outwards.
[[nodiscard]] RTCBounds rounded(const Bounds& box);
/// Of a committed scene, in its search coordinates.
[[nodiscard]] Bounds bounds_of_tree(RTCSceneTy* scene);

// Callbacks of a model's own surfaces (user data: Hierarchy) and of the instances of models (user
// data: Instances).
void primitive_bounds(const RTCBoundsFunctionArguments* args);
void intersect_primitive(const RTCIntersectFunctionNArguments* args);
void occlude_primitive(const RTCOccludedFunctionNArguments* args);
// The same of leaves.
void leaf_bounds(const RTCBoundsFunctionArguments* args);
void intersect_leaf(const RTCIntersectFunctionNArguments* args);
void occlude_leaf(const RTCOccludedFunctionNArguments* args);
void instance_bounds(const RTCBoundsFunctionArguments* args);
void intersect_instance(const RTCIntersectFunctionNArguments* args);
void occlude_instance(const RTCOccludedFunctionNArguments* args);

}  // namespace lightwalk
