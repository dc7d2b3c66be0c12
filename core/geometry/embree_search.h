#pragma once
// How Embree searches a placed scene: the callbacks, and the records that it hands to them.
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

/// A model placed in another one, as a user-defined primitive of that one's search tree. An Embree
/// instance would take half a kilobyte, and cannot be nested.
struct Instance {
    std::array<float, 12>
        inverse{};  ///< transform into the model: images of the three axes and of the origin
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
    // What Embree treats as its primitives: the BVH primitives (whose boxes are kept only while the
    // tree is built), or in large models leaves of up to eight of them.
    BvhPrimitives bvh_primitives;
    std::vector<QuantizedLeaf> leaves;
    Instances instances;
    ScenePtr scene;
    std::vector<Bounds> outline;  ///< of everything in the tree, in the search coordinates; only
                                  ///< while trees are built
};

class InstanceScope;

/// The context of one traversal, which Embree hands to the callbacks.
struct Query : RTCIntersectContext {
    const PlacedScene* placed = nullptr;
    InstanceScope* within =
        nullptr;  ///< the placed model that the search is in; null: the scene itself
};
/// A search for nearest hits. Ray i of a packet has Embree's ray id i.
struct NearestQuery : Query {
    NearestRay* rays = nullptr;
    std::array<double, kPacket> start{};  ///< distance of Embree's origin from the true one [m]
};
struct ShadowQueries : Query {
    ShadowRay* rays = nullptr;
};

/// Make Embree skip all rays of a packet. Without AVX-512 Embree ignores the mask of valid lanes,
/// and skips only rays that end before they begin.
void close_lanes(RTCRayHit16& packet);

/// tfar of Embree's ray, rounded so that no hit up to `limit` is lost.
[[nodiscard]] float embree_end(double limit, double start);

/// The box in single precision, rounded outwards.
[[nodiscard]] RTCBounds rounded(const Bounds& box);
/// Bounds of a committed Embree scene, in its search coordinates.
[[nodiscard]] Bounds bounds_of_tree(RTCSceneTy* scene);

// Callbacks of a model's own surfaces (user data: Hierarchy) and of the instances of models (user
// data: Instances).
void primitive_bounds(const RTCBoundsFunctionArguments* args);
void intersect_primitive(const RTCIntersectFunctionNArguments* args);
void occlude_primitive(const RTCOccludedFunctionNArguments* args);
// Callbacks of quantized leaves (user data: Hierarchy).
void leaf_bounds(const RTCBoundsFunctionArguments* args);
void intersect_leaf(const RTCIntersectFunctionNArguments* args);
void occlude_leaf(const RTCOccludedFunctionNArguments* args);
void instance_bounds(const RTCBoundsFunctionArguments* args);
void intersect_instance(const RTCIntersectFunctionNArguments* args);
void occlude_instance(const RTCOccludedFunctionNArguments* args);

}  // namespace lightwalk
