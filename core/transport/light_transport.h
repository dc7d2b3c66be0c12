#pragma once
// What materials, light sources and the ambient calculation ask while a ray is shaded: other rays,
// direct and indirect light. Radiance's backward ray tracing; core/trace implements it.
#include <span>

#include "core/math/function_ref.h"
#include "core/scene/scene.h"
#include "core/transport/light_samples.h"
#include "core/transport/options.h"
#include "core/transport/ray.h"
#include "core/transport/trace_context.h"

namespace lightwalk {

class LightSources;
struct GroupAccount;

/// A shaded point that wants direct light.
struct DirectRequest {
    Ray* ray;  ///< whose hit it is; the light is added to its value
    DirectCoefficient coefficient;
    const Vec3* front = nullptr;  ///< see LightTransport::add_direct
    GroupAccount* account =
        nullptr;  ///< where groups of emitters are told of; null: the current one
};

/// What a ray to a light would inherit from the ray at whose hit it starts.
struct ShadowStart {
    double weight = 1;
    double path_length = 0, shadow_length = 0;  ///< see RayPath [m]
    RandomStream random;
};

/// No state between rays: any number of threads may use one, each with its own context.
class LightTransport {
  public:
    /// Rays that may be nested; deeper ones return black, as the stack is finite.
    static constexpr int kMaxDepth = 1000;

    LightTransport(const LightTransport&) = delete;
    LightTransport& operator=(const LightTransport&) = delete;

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const RenderOptions& options() const { return options_; }
    [[nodiscard]] virtual const LightSources& lights() const = 0;

    // ---- rays (spawn.cpp)
    /// A primary ray in the global medium.
    /// @param direction  of any length
    /// @param limit      aft clipping distance; 0: none [m]
    [[nodiscard]] Ray primary(const Vec3& origin, const Vec3& direction, double limit,
                              RandomStream random) const;
    /// The same for a new ray where it stands: rays are large, and to copy them takes time.
    void start_primary(Ray& ray, const Vec3& origin, const Vec3& direction, double limit,
                       RandomStream random) const;

    /// Prepare a child of `parent`, whose hit is set; the caller sets child.direction and calls
    /// trace().
    /// @param coef  factor of the child's radiance in the parent's; null: 1, and not bound by the
    ///              limits for coefficients
    /// @return      false: the ray is not to be traced (-lr, -lw); most callers then drop the
    ///              component
    [[nodiscard]] bool spawn(Ray& child, RayKind kind, Ray& parent, const Rgb* coef) const;

    /// Draws from the parent's random numbers.
    [[nodiscard]] static ShadowStart start_shadow(Ray& parent);

    /// child.value times child.coef is added to parent.value.
    /// @return  what was added [W/(m² sr)]
    static Rgb accumulate(Ray& parent, const Ray& child);

    /// Evaluate a ray whose origin and direction are set (primary or spawned): nearest hit or
    /// background, shading, medium. The radiance is in the ray then. Never throws for numeric
    /// trouble: a radiance that is not finite becomes 0 and is reported. A ray with `aimed` set
    /// meets its target's object only.
    virtual void trace(Ray& ray, TraceContext& context) const = 0;

    /// Evaluate rays whose nearest hits are known, as trace() would. They are shaded together
    /// where that is faster; what each brings back does not depend on the others.
    /// @param hits  one a ray
    virtual void shade_hits(std::span<Ray> rays, std::span<const Hit> hits,
                            TraceContext& context) const = 0;
    /// The same, with context.groups; shaded(i) is called while these hold what ray i has brought,
    /// and nothing else.
    virtual void shade_hits(std::span<Ray> rays, std::span<const Hit> hits, TraceContext& context,
                            FunctionRef<void(std::size_t)> shaded) const = 0;

    /// Call `branch`, which evaluates one branch of a mixture, on a stack that is large enough.
    virtual void enter_mixture(TraceContext& context, FunctionRef<void()> branch) const = 0;

    // ---- modifier chains (shading.cpp)
    /// Shade with a modifier chain: textures and patterns act until a modifier produces a value.
    /// @return  false: there was none
    [[nodiscard]] bool shade_chain(Ray& ray, ModifierId first, TraceContext& context) const;
    /// Shade with a chain, passing through when it has no material.
    void shade_or_pass(Ray& ray, ModifierId first, TraceContext& context) const;
    /// Run the textures and patterns below a material (its own modifier chain). Throws InputError
    /// for a material there.
    void apply_textures(Ray& ray, ModifierId material_next, TraceContext& context) const;
    /// Ignore the surface: the ray goes on, and what it brings back is taken over unchanged.
    void pass_through(Ray& ray, TraceContext& context) const;

    // ---- light
    /// Indirect light times `coef` at the hit about `normal`; the constant -av where there is no
    /// ambient calculation [W/(m² sr)].
    [[nodiscard]] virtual Rgb ambient(Ray& ray, const Rgb& coef, const Vec3& normal,
                                      TraceContext& context) const = 0;

    /// Add direct light of all sources to ray.value. The last thing that a material does: other
    /// rays may be shaded before it returns.
    /// @param front  where given, the coefficient is 0 for light from behind this normal, so that
    ///               sources that lie there need not be looked at
    virtual void add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context,
                            const Vec3* front = nullptr) const = 0;

  protected:
    LightTransport(const Scene& scene, const RenderOptions& options)
        : scene_(scene), options_(options) {}
    virtual ~LightTransport() = default;

  private:
    const Scene& scene_;
    RenderOptions options_;
};

/// The perturbed normal and its cosine with the ray. `normal` and `cos_out` may have been flipped
/// by the caller.
struct PerturbedNormal {
    Vec3 normal;
    double cosine = 1;  ///< with wo = -direction; of the same sign as cos_out
};
/// The normal plus the textures' perturbation, normalised; reflected to the ray's side when the
/// perturbation turned it away.
[[nodiscard]] PerturbedNormal perturb_normal(const Ray& ray);

/// Turn the hit over: negate normal, perturbation and cos_out.
void flip_surface(Ray& ray);

}  // namespace lightwalk
