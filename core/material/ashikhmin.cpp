// ashik2: diffuse base under an anisotropic Phong lobe.
// Source: Ashikhmin & Shirley, "An Anisotropic Phong BRDF Model", Journal of Graphics Tools 5
// (2000), as Radiance's manual "The Radiance 6.x Scene Description Language" parametrises it.
#include "core/material/argument_checks.h"
#include "core/material/lobes.h"
#include "core/material/orientation.h"
#include "core/material/rough_samples.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"

namespace lightwalk {
namespace {

/// (1 - cosθ)⁵: Schlick's approximation of what Fresnel's law adds to the reflectance at normal
/// incidence, as a share of the rest.
double schlick(double cosine) {
    const double x = 1 - cosine;
    const double x2 = x * x;
    return x2 * x2 * x;
}

/// What one hit makes of the material.
struct AshikhminShading {
    Rgb color, specular;
    AshikhminReflection lobe;
};

class Ashikhmin final : public Modifier {
  public:
    explicit Ashikhmin(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override { return {.blocks_shadow_rays = true}; }

  private:
    [[nodiscard]] AshikhminShading prepare(const Ray& ray, TraceContext& context) const;
    [[nodiscard]] Rgb direct(const AshikhminShading& s, const Vec3& wi, double omega) const;

    ModifierId next_;
    std::string name_;
    Orientation orientation_;
    Rgb color_, specular_;
    double nu_, nv_;
    bool active_;  ///< has a specular lobe
};

Ashikhmin::Ashikhmin(const ModifierBuild& build)
    : next_(build.next),
      name_(build.primitive.name),
      orientation_((require_exact_reals(build.primitive, 8), build)),
      color_(color_argument(build.primitive)),
      specular_(color_argument(build.primitive, 3)),
      nu_(build.primitive.reals[6]),
      nv_(build.primitive.reals[7]),
      active_(max_component(specular_) > static_cast<float>(kEpsilon)) {}

bool Ashikhmin::shade(Ray& ray, TraceContext& context) const {
    if (ray.in(kShadow)) return true;
    if (!turn_to_viewer(ray, next_, context)) return true;
    const LightTransport& tracer = context.tracer;
    const AshikhminShading s = prepare(ray, context);
    const bool dim = tracer.options().specular_threshold >=
                     static_cast<double>(brightness(specular_)) - kEpsilon;
    if (active_ && !dim) add_rough_reflection(ray, s.lobe, s.specular, context);
    if (max_component(s.color) > static_cast<float>(kEpsilon)) {
        const Rgb coef = active_ && dim ? s.color + s.specular : s.color;
        ray.value += tracer.ambient(ray, coef, s.lobe.frame.n, context);
    }
    tracer.add_direct(
        ray, one_by_one([&](const Vec3& wi, double omega) { return direct(s, wi, omega); }),
        context);
    return true;
}

AshikhminShading Ashikhmin::prepare(const Ray& ray, TraceContext& context) const {
    const PerturbedNormal facing = perturb_normal(ray);
    const OrientedFrame oriented = orientation_.at(ray, facing.normal, context);
    AshikhminShading s;
    s.color = color_ * ray.pattern;
    s.lobe = {-ray.direction, std::max(facing.cosine, kMinCosine), oriented.frame, nu_, nv_};
    s.specular = specular_ + (Rgb{1, 1, 1} - specular_) * static_cast<float>(schlick(s.lobe.cos_o));
    if (oriented.isotropic) {
        if (std::fabs(nu_ - nv_) > 0.1) {
            context.warnings.warn("ashik2 \"" + name_ +
                                  "\": illegal orientation vector: along the normal");
        }
        s.lobe.nu = s.lobe.nv = 2 / (1 / (nu_ + 1e-5) + 1 / (nv_ + 1e-5));
    }
    return s;
}

Rgb Ashikhmin::direct(const AshikhminShading& s, const Vec3& wi, double omega) const {
    const double cos_i = dot(s.lobe.frame.n, wi);
    if (cos_i <= kEpsilon) return {};
    Rgb sum = s.color * static_cast<float>(cos_i * omega / kPi * (1 - schlick(cos_i)));
    if (active_) {
        const double f = s.lobe.eval(wi);
        if (f > kEpsilon) sum += s.specular * static_cast<float>(f * cos_i * omega);
    }
    return sum;
}

}  // namespace

std::unique_ptr<const Modifier> make_ashikhmin(const ModifierBuild& build) {
    return std::make_unique<Ashikhmin>(build);
}

}  // namespace lightwalk
