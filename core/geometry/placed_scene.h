#pragma once
// Decides which surface a ray hits: Radiance's rules in double precision, independent of the order
// in which a search (Embree) proposes candidates. The search must propose at least every true
// crossing up to `limit`.
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/geometry/instances.h"
#include "core/geometry/model_primitives.h"

namespace lightwalk {

/// A ray in the space of a placed model; distances there times `size` are distances in the world.
struct LocalRay {
    Vec3 origin, direction;
    double size = 1;
};

/// What a crossing means for a shadow ray's way to its target.
enum class Obstacle : std::uint8_t {
    none,      ///< it lies behind the target, or coincides with it and is not seen
    in_front,  ///< it is met instead of the target
    unsure,    ///< so near the target that only the search for the nearest hit tells which is met
};

/// A primitive of a placed model.
struct PrimitiveRef {
    InstanceId instance = kWorld;
    std::uint32_t primitive = 0;
    friend bool operator==(const PrimitiveRef&, const PrimitiveRef&) = default;
    friend bool operator<(const PrimitiveRef& a, const PrimitiveRef& b) {
        return std::tie(a.instance, a.primitive) < std::tie(b.instance, b.primitive);
    }
};

/// A crossing of a ray with a primitive.
struct Candidate {
    double t = kHuge;  ///< in the world [m]
    PrimitiveRef what;
    ShapeHit local;  ///< in the space of the placed model
};

/// A ray that is being traced, with the local ray of the placed model that the search is in.
struct TracedRay {
    Vec3 origin, direction;
    double limit = kHuge;  ///< farther candidates are irrelevant; never increases [m]
    InstanceId local_instance = kWorld;
    // Valid where local_instance is not kWorld: the ray in that instance.
    LocalRay local;
    std::uint32_t local_model = 0;
    SurfaceId local_override = kNoSurface;  ///< see PlacedModel
};

/// A search for the nearest hit: the nearest crossing, and the distance of the second nearest.
struct NearestRay : TracedRay {
    std::optional<Candidate> nearest;
    double second =
        std::numeric_limits<double>::infinity();  ///< least t of all other crossings [m]
    std::vector<Candidate>* all =
        nullptr;                 ///< not null: collect every crossing up to `limit` instead
    bool out_of_memory = false;  ///< `all` could not grow
};

/// A shadow search: what lies between a point and a light.
struct ShadowRay : TracedRay {
    double t_max = kHuge;  ///< to the target, where there is one; else to where the search ends [m]
    SurfaceId target = kNoSurface;
    Visibility result = Visibility::clear;
    PrimitiveRef blocker;  ///< where blocked
    std::optional<Precedence>
        target_precedence;  ///< filled when something coincides with the target
};

class PlacedScene {
  public:
    /// Throws InputError as InstancePaths and ModelPrimitives do.
    PlacedScene(GeometryInput input, const TaskRunner& task_runner);

    [[nodiscard]] const InstancePaths& paths() const { return paths_; }
    [[nodiscard]] const ModelPrimitives& primitives(std::uint32_t model) const {
        return models_[model];
    }
    [[nodiscard]] std::size_t model_count() const { return models_.size(); }
    [[nodiscard]] Bounds bounds() const {
        return bounds_;
    }  ///< of everything, placed models by their cubes
    [[nodiscard]] Transform transform(InstanceId instance) const {
        return paths_.at(instance).to_world;
    }
    [[nodiscard]] std::size_t memory_bytes() const;

    /// Make `ray.local` the ray in a placed model's space.
    static void enter(TracedRay& ray, InstanceId instance, const InnerSpace& space);

    /// Start a search; whatever `ray` held before is forgotten.
    static void begin(NearestRay& ray, const RaySegment& segment);
    /// Propose a primitive. Lowers ray.limit where it was hit; true: `limit` has changed.
    bool propose(NearestRay& ray, PrimitiveRef what) const;
    /// Whether the search has to be repeated with `begin_gathering`, because crossings coincide
    /// within the tolerance.
    [[nodiscard]] bool is_ambiguous(const NearestRay& ray) const;
    void begin_gathering(NearestRay& ray, const RaySegment& segment, const NearestRay& first,
                         std::vector<Candidate>& all) const;
    /// The crossing that wins: within each placed model Radiance's tie rules, between them the
    /// nearer one.
    [[nodiscard]] Candidate resolve(std::vector<Candidate>& all) const;
    [[nodiscard]] Hit hit_of(const RaySegment& segment, const Candidate& winner) const;
    [[nodiscard]] Hit intersect_surface(SurfaceId surface, const RaySegment& segment) const;

    static void begin(ShadowRay& ray, const RaySegment& segment, SurfaceId target);
    /// Propose a primitive. True: the light is blocked, the search may end.
    bool propose(ShadowRay& ray, PrimitiveRef what) const;

  private:
    [[nodiscard]] Hit hit_in(const PlacedModel& placed, const RaySegment& segment,
                             const Candidate& winner) const;
    [[nodiscard]] const ModelPrimitives& model_of(InstanceId instance) const {
        return models_[instance == kWorld ? 0 : paths_.space_at(instance).model];
    }
    [[nodiscard]] Surface surface(SurfaceId id) const { return (*input_.surfaces)[id]; }
    void enter(TracedRay& ray, InstanceId instance) const {
        if (ray.local_instance != instance) enter(ray, instance, paths_.space_at(instance));
    }
    [[nodiscard]] std::optional<Candidate> cross(TracedRay& ray, PrimitiveRef what) const;
    [[nodiscard]] Precedence precedence(const Candidate& candidate) const;
    [[nodiscard]] ShadowClass shadow_class(const ShadowRay& ray, PrimitiveRef what) const;
    [[nodiscard]] static bool meets_back(const ShadowRay& ray, const Candidate& candidate);
    [[nodiscard]] Obstacle obstacle(ShadowRay& ray, const Candidate& candidate) const;
    [[nodiscard]] Obstacle beside_target(ShadowRay& ray, const Candidate& candidate) const;
    [[nodiscard]] bool hides_target(ShadowRay& ray, const Candidate& candidate) const;
    [[nodiscard]] Bounds model_bounds(std::uint32_t model,
                                      std::vector<std::optional<Bounds>>& cubes) const;

    GeometryInput input_;
    InstancePaths paths_;
    PlacedModel world_;  ///< the scene itself
    std::vector<ModelPrimitives> models_;
    Bounds bounds_;
    double coincidence_ =
        kEpsilon;  ///< tolerance of coincidence in the most enlarged placed model [m]
};

}  // namespace lightwalk
