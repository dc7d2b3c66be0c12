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

/// Schlick's (1 - cosθ)⁵.
double schlick(double cosine) {
    const double x = 1 - cosine;
    const double x2 = x * x;
    return x2 * x2 * x;
}

/// What one hit makes of the material.
struct Shading {
    Rgb color, specular;
    LobeFrame frame;
    double cosine = 1;  ///< -v . np
    double nu = 0, nv = 0;
};

class Ashikhmin final : public Modifier {
  public:
    explicit Ashikhmin(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override { return {.blocks_shadow_rays = true}; }

  private:
    [[nodiscard]] Shading prepare(const Ray& ray, TraceContext& context) const;
    void add_rough(Ray& ray, const Shading& s, TraceContext& context) const;
    [[nodiscard]] Rgb direct(const Shading& s, const Vec3& v, const Vec3& l, double omega) const;

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
    const Tracer& tracer = context.tracer;
    const Shading s = prepare(ray, context);
    const bool dim = tracer.options().specular_threshold >=
                     static_cast<double>(brightness(specular_)) - kEpsilon;
    if (active_ && !dim) add_rough(ray, s, context);
    if (max_component(s.color) > static_cast<float>(kEpsilon)) {
        const Rgb coef = active_ && dim ? s.color + s.specular : s.color;
        ray.value += tracer.ambient(ray, coef, s.frame.n, context);
    }
    const Vec3 v = ray.direction;
    tracer.add_direct(
        ray, one_by_one([&](const Vec3& l, double omega) { return direct(s, v, l, omega); }),
        context);
    return true;
}

Shading Ashikhmin::prepare(const Ray& ray, TraceContext& context) const {
    const PerturbedNormal facing = perturb_normal(ray);
    const OrientedFrame oriented = orientation_.at(ray, facing.normal, context);
    Shading s;
    s.color = color_ * ray.pattern;
    s.frame = oriented.frame;
    s.cosine = std::max(facing.cosine, kMinCosine);
    s.specular = specular_ + (Rgb{1, 1, 1} - specular_) * static_cast<float>(schlick(s.cosine));
    s.nu = nu_;
    s.nv = nv_;
    if (oriented.isotropic) {
        if (std::fabs(nu_ - nv_) > 0.1) {
            context.warnings.warn("ashik2 \"" + name_ +
                                  "\": illegal orientation vector: along the normal");
        }
        s.nu = s.nv = 2 / (1 / (nu_ + 1e-5) + 1 / (nv_ + 1e-5));
    }
    return s;
}

void Ashikhmin::add_rough(Ray& ray, const Shading& s, TraceContext& context) const {
    const Vec3 true_normal = ray.hit.normal;
    const auto draw = [&](Ray& from) -> std::optional<Vec3> {
        const double xi1 = from.random.next();
        const double xi2 = from.random.next();
        const std::optional<Vec3> half = sample_ashikhmin_half(s.frame, s.nu, s.nv, xi1, xi2);
        if (!half) return std::nullopt;
        const Vec3 l = reflect_off(from.direction, *half, 1);
        if (dot(l, true_normal) <= kEpsilon) return std::nullopt;
        return l;
    };
    const auto weight = [](const Vec3&, int) { return 1.0; };
    add_rough_samples(ray, kSpecularReflected, s.specular, context, draw, weight, false);
}

Rgb Ashikhmin::direct(const Shading& s, const Vec3& v, const Vec3& l, double omega) const {
    const double k = dot(s.frame.n, l);
    if (k <= kEpsilon) return {};
    Rgb sum = s.color * static_cast<float>(k * omega / kPi * (1 - schlick(k)));
    if (active_) {
        const double lobe = ashikhmin_reflection(l, v, s.cosine, s.frame, s.nu, s.nv);
        if (lobe > kEpsilon) sum += s.specular * static_cast<float>(lobe * k * omega);
    }
    return sum;
}

}  // namespace

std::unique_ptr<const Modifier> make_ashikhmin(const ModifierBuild& build) {
    return std::make_unique<Ashikhmin>(build);
}

}  // namespace lightwalk
