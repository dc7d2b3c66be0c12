#pragma once
// Ray casting: Embree behind an interface that speaks double precision and Radiance's tie rules.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ablation.h"
#include "core/geometry/surface.h"
#include "core/math/transform.h"
#include "core/model/ids.h"
#include "core/model/primitive.h"

namespace lightwalk {

/// Where a ray met the scene. Default: nothing was hit.
struct Hit {
    double t = kHuge;       ///< along the ray [m]
    Vec3 position, normal;  ///< world; normal is unit and NOT turned to the ray
    double cos_out = 1;     ///< cosine of wo = -direction with the normal; > 0 on the front
    Vec3 perturbation;      ///< smoothed mesh normal minus normal, else zero
    double u = 0, v = 0;    ///< mesh texture coordinates, else zero
    SurfaceId surface =
        kNoSurface;                ///< the inner surface, or the instance whose modifier overrides
    ModifierId modifier = kVoid;   ///< the direct modifier that shades
    InstanceId instance = kWorld;  ///< placement of the local space that `modifier` lives in
    [[nodiscard]] bool exists() const { return surface != kNoSurface; }
};

/// Answer of a shadow query.
enum class Visibility : std::uint8_t {
    clear,          ///< nothing but material-less surfaces, or backs of illums, in between
    blocked,        ///< an opaque surface lies in between
    needs_shading,  ///< no opaque surface, but at least one of ShadowClass::needs_shading, or one
                    ///< that nearly coincides with the target: the nearest hit tells which is seen
};

/// Axis-aligned bounds.
struct Bounds {
    Vec3 lower{kHuge, kHuge, kHuge}, upper{-kHuge, -kHuge, -kHuge};
    [[nodiscard]] bool empty() const { return lower.x > upper.x; }
    void extend(const Vec3& p);
};

/// A mesh inside a model: triangles whose materials are global modifiers.
struct MeshPart {
    const MeshModel* mesh = nullptr;
    std::vector<ModifierId> materials;  ///< mesh-local material index -> global modifier
    std::vector<SurfaceTraits> traits;  ///< by mesh-local material index
    SurfaceTraits void_traits;          ///< of triangles without material
    SurfaceId surface = kNoSurface;     ///< reported for hits ("M-Tri")
};

/// A model placed inside another one.
struct Placement {
    std::uint32_t model = 0;  ///< into GeometryInput::models
    Transform transform;
    SurfaceId surface = kNoSurface;  ///< the instance or mesh primitive
    bool overrides = false;          ///< its modifier is not void: it shades everything inside
};

struct ModelGeometry {
    std::size_t part = 0;          ///< of the SurfaceTable: its surfaces
    std::vector<MeshPart> meshes;  ///< 0 or 1: a compiled mesh as a model of its own
    std::vector<Placement> placements;
    std::optional<Bounds> cube;  ///< as the octree states it; else the smallest one is derived
};

struct GeometryInput {
    const SurfaceTable* surfaces = nullptr;  ///< must outlive the Geometry
    std::vector<ModelGeometry> models;       ///< models[0] is the scene; placements form a DAG
    Ablation ablation = {};
};

struct RaySegment {
    Vec3 origin, direction;  ///< direction is unit
    double t_max = kHuge;    ///< hits beyond it do not count [m]
};

/// The opaque surface that blocked a shadow ray: the next ray is tested against it first.
struct Blocker {
    InstanceId instance = kWorld;
    std::uint32_t primitive = kNone;
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

/// A shadow query: what lies between a point and a light?
struct ShadowQuery {
    /// Up to the light: where a target is given, t_max is the distance of its crossing.
    RaySegment ray;
    /// The light's own surface: it casts no shadow, and takes part in the tie rule.
    SurfaceId target = kNoSurface;
    Blocker* last =
        nullptr;  ///< cache of the last blocker, read and updated; affects speed only; may be null
};

/// Memory that the search takes [bytes].
struct SearchMemory {
    std::size_t tree = 0;    ///< Embree's
    std::size_t tables = 0;  ///< tables beside Embree's tree
};

/// Immutable after building; every method may be called from many threads at once.
class Geometry {
  public:
    /// Throws InputError when nested placements multiply to more than 2^22 instances or are nested
    /// more than 32 deep, when one scales by less than 1e-7 or more than 1e7 in all, and for
    /// damaged meshes. Embree builds on oneTBB's default threads. Answers are bit-identical for
    /// single rays and packets; they need no flush-to-zero mode of the caller. A surface of a
    /// placed model wins over coincident surfaces outside it only where it is strictly nearer; tie
    /// rules apply among the surfaces of one model. `embree_options` configures the search, for
    /// tests: "isa=avx2" makes it work as on machines without AVX-512. `task_runner` runs the
    /// preparations outside Embree.
    explicit Geometry(GeometryInput input, const std::string& embree_options = {},
                      const TaskRunner& task_runner = SerialTaskRunner());
    ~Geometry();
    Geometry(Geometry&&) noexcept;
    Geometry& operator=(Geometry&&) noexcept;

    /// Nearest hit with t > kEpsilon; ties within kEpsilon follow Radiance's rules. Infinite
    /// sources are not geometry. Returns a Hit with exists() false when there is none (t = kHuge).
    [[nodiscard]] Hit intersect(const RaySegment& ray) const;

    /// Nearest hit with one given finite surface of the scene itself (not inside an instance).
    [[nodiscard]] Hit intersect_surface(SurfaceId surface, const RaySegment& ray) const;

    /// Visibility between the origin and t_max, exclusive; with a target, whether a ray of any
    /// other kind would meet it. Arguments as in ShadowQuery.
    [[nodiscard]] Visibility visibility(const RaySegment& ray, SurfaceId target,
                                        Blocker* last = nullptr) const;
    /// Visibility of many shadow queries at once; answers.size() == queries.size(). Faster only
    /// where rays are coherent: from neighbouring points to the same light (measured on interiors:
    /// a third faster; from one point to all lights a third slower).
    void visibility(std::span<const ShadowQuery> queries, std::span<Visibility> answers) const;

    /// Nearest hits of many coherent rays at once (primary rays); out.size() == rays.size().
    void intersect(std::span<const RaySegment> rays, std::span<Hit> out) const;

    [[nodiscard]] Transform instance_transform(
        InstanceId id) const;                          ///< local -> world of an instance path
    [[nodiscard]] Bounds bounds() const;               ///< of everything finite, world
    [[nodiscard]] std::size_t instance_count() const;  ///< instances, one a path
    [[nodiscard]] SearchMemory memory() const;         ///< without the surfaces and meshes

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lightwalk
