#pragma once
// Radiance along a ray: Radiance's backward ray tracing without state between rays.
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/function/program.h"
#include "core/math/function_ref.h"
#include "core/scene/scene.h"
#include "core/transport/light_samples.h"
#include "core/transport/options.h"
#include "core/transport/ray.h"

namespace lightwalk {

class AmbientCache;
class AmbientCalculation;
struct NewAmbientRecords;
struct MissingAmbient;
class LightSources;
class Fibers;
class ShadingBatch;
class Tracer;

using MakeFibers = std::unique_ptr<Fibers> (*)(std::size_t count);  ///< see core/batch/fibers.h

/// Rays traced, by purpose.
struct RayCounters {
    std::uint64_t primary = 0, shadow = 0, specular = 0, transmitted = 0, ambient = 0;
    RayCounters& operator+=(const RayCounters& o);
    [[nodiscard]] std::uint64_t total() const {
        return primary + shadow + specular + transmitted + ambient;
    }
};

/// Ambient values asked for, by how they were found.
struct AmbientCounters {
    std::uint64_t interpolated = 0;  ///< from the cache
    std::uint64_t computed = 0;      ///< by a hemisphere of rays
    std::uint64_t incomplete =
        0;                    ///< of these: some rays could not start, so that nothing was stored
    std::uint64_t waits = 0;  ///< for a value that another thread computed
    std::uint64_t duplicates =
        0;  ///< computed, though by then another thread's value would have served
    AmbientCounters& operator+=(const AmbientCounters& o);
};

struct ClipSet {
    std::vector<ModifierId> modifiers;  ///< sorted
    [[nodiscard]] bool contains(ModifierId m) const;
};

struct ScatterList {
    std::vector<std::int32_t> sources;  ///< into LightSources
    [[nodiscard]] bool contains(std::int32_t source) const;
};

inline constexpr std::size_t kSideBySide = 64;  ///< evaluations of one function at a time

struct LightScratch;  ///< the direct calculation's buffers (core/light)

/// Watches rays as they are finished, children before their parents. It is not told of rays that
/// only ask a light source for its radiance, nor of shadow rays that an opaque surface stops.
class RayObserver {
  public:
    virtual ~RayObserver() = default;
    /// `first`: the nearest hit before shading turned anything over. `ray.parent` leads to the
    /// primary ray; they live during the call only.
    virtual void finished(const Ray& ray, const Hit& first) = 0;
};

/// One thread's working state. Not shared; reusable for any number of rays.
struct TraceContext {
    TraceContext(const Tracer& tracer, WarningSink& warnings);
    ~TraceContext();
    TraceContext(const TraceContext&) = delete;
    TraceContext& operator=(const TraceContext&) = delete;

    /// A path starts: the sets of the one before are forgotten. Tracer calls it where a ray is
    /// evaluated while no other is open.
    void start_path();

    const Tracer& tracer;
    WarningSink& warnings;
    RayCounters counters;
    EvalState eval;
    ChannelValues channels{};
    std::array<ChannelValues, kSideBySide> lane_channels{};  ///< of evaluations side by side
    std::unique_ptr<LightScratch> light;
    MakeFibers make_fibers = nullptr;  ///< for rays that wait for each other; null: none wait
    /// Of shade_hits(), one inside the other; made when first needed.
    std::vector<std::unique_ptr<ShadingBatch>> batches;
    std::size_t open_batches = 0;   ///< of these: in use
    ShadingBatch* batch = nullptr;  ///< the one whose fiber this code runs on; null: on none
    int depth = 0;                  ///< nesting of rays, bounded by Tracer::kMaxDepth
    int ambient_level = 0;          ///< ambient evaluations that are open
    AmbientCounters ambient;
    RayObserver* observer = nullptr;  ///< told of every ray; null: nobody watches
    /// Takes the ambient values that are missing, and there is no direct light; null: they are
    /// computed.
    MissingAmbient* missing = nullptr;
    NewAmbientRecords* new_records = nullptr;  ///< takes those that are computed; null: the cache
    // Sets made on the way (antimatter, mist); forgotten when a path starts.
    std::deque<ClipSet> clip_sets;
    std::deque<ScatterList> scatter_lists;
};

/// A shaded point that wants direct light.
struct DirectRequest {
    Ray* ray;  ///< whose hit it is; the light is added to its value
    DirectCoefficient coefficient;
    const Vec3* front = nullptr;  ///< see Tracer::add_direct
};

class Tracer {
  public:
    static constexpr int kMaxDepth =
        1000;  ///< nested rays; deeper ones return black (the stack is finite)

    /// Prepares light sources (virtual ones included) and their frozen visibility statistics.
    /// Throws InputError for illegal light sources.
    Tracer(const Scene& scene, const RenderOptions& options, WarningSink& warnings,
           const TaskRunner& task_runner = SerialTaskRunner());
    ~Tracer();
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const RenderOptions& options() const { return options_; }
    [[nodiscard]] const LightSources& lights() const { return *lights_; }

    /// A primary ray with the global medium; `direction` is normalised here.
    [[nodiscard]] Ray primary(const Vec3& origin, const Vec3& direction, double limit,
                              RandomStream random) const;

    /// Evaluate a ray whose origin and direction are set (primary or spawned): nearest hit or
    /// background, shading, medium. The result is in the ray. Never throws for numeric trouble; a
    /// non-finite result becomes 0 and is reported. Calls for ray.aimed rays intersect the target's
    /// object only.
    void trace(Ray& ray, TraceContext& context) const;

    /// The same when the nearest hit is known already (primary packets).
    void shade_hit(Ray& ray, const Hit& hit, TraceContext& context) const;

    /// The same for many rays, which go side by side where that is faster; what each brings back is
    /// the same. hits.size() == rays.size().
    void shade_hits(std::span<Ray> rays, std::span<const Hit> hits, TraceContext& context) const;

    /// Call `deeper`, which goes deeper in rays or mixtures: on a stack that is large enough.
    static void go_deeper(TraceContext& context, FunctionRef<void()> deeper);

    /// Irradiance at a sensor point facing `normal` (rtrace -I): the radiance of an ideal white
    /// surface there.
    [[nodiscard]] Ray irradiance(const Vec3& point, const Vec3& normal, RandomStream random,
                                 TraceContext& context) const;

    /// Prepare a child of `parent` (whose hit is set); the caller sets child.direction and calls
    /// trace. `coef` null: none given. False: the ray is not to be traced (limits); most callers
    /// then drop the component.
    [[nodiscard]] bool spawn(Ray& child, RayKind kind, Ray& parent, const Rgb* coef) const;

    /// What a ray to a light would inherit from `parent`: its weight and random numbers, and
    /// lengths.
    struct ShadowStart {
        double weight = 1;
        double path_length = 0, shadow_length = 0;  ///< see Ray [m]
        RandomStream random;
    };
    [[nodiscard]] static ShadowStart start_shadow(Ray& parent);

    /// child.value times child.coef is added to parent.value; returns the contribution.
    static Rgb accumulate(Ray& parent, const Ray& child);

    /// Shade with a modifier chain: textures and patterns act until a modifier produces a value.
    /// False: there was none.
    [[nodiscard]] bool shade_chain(Ray& ray, ModifierId first, TraceContext& context) const;
    /// Shade with a chain, passing through when it has no material.
    void shade_or_pass(Ray& ray, ModifierId first, TraceContext& context) const;
    /// Run the textures and patterns below a material (its own modifier chain). A material there is
    /// an InputError.
    void apply_textures(Ray& ray, ModifierId material_next, TraceContext& context) const;

    /// Ignore the surface: the ray goes on, and what it brings back is taken over unchanged.
    void pass_through(Ray& ray, TraceContext& context) const;

    /// Where -ab > 0 and -aa > 0 keep their values; it must outlive the tracer's use. Null: every
    /// value is computed anew, as with -aa 0. Not while rays are traced.
    void use_ambient_cache(AmbientCache* cache);
    /// Indirect light times `coef` at the hit about `normal` (the constant -av when there is no
    /// ambient calculation).
    [[nodiscard]] Rgb ambient(Ray& ray, const Rgb& coef, const Vec3& normal,
                              TraceContext& context) const;

    /// Add direct light of all sources to ray.value. `front`: where given, the coefficient is 0 for
    /// light from behind it, so that sources that lie there need not be looked at.
    void add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context,
                    const Vec3* front = nullptr) const;

    /// Apply the medium to the segment of a finished ray.
    void apply_medium(Ray& ray, TraceContext& context) const;

  private:
    const Scene& scene_;
    RenderOptions options_;
    std::unique_ptr<LightSources> lights_;
    std::unique_ptr<AmbientCalculation> ambient_;
};

/// The perturbed normal and its cosine with the ray. `normal` and `cos_out` may have been flipped
/// by the caller.
struct PerturbedNormal {
    Vec3 normal;
    double cosine = 1;  ///< -direction . normal, of the same sign as cos_out
};
/// n' = n + d, normalised; reflected to the ray's side when the perturbation turned it away.
[[nodiscard]] PerturbedNormal perturb_normal(const Ray& ray);

/// Turn the hit over: negate normal, perturbation and cos_out.
void flip_surface(Ray& ray);

}  // namespace lightwalk
