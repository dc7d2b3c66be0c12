// glass: a thin pane with internal absorption and reflections.
// Sources: Born & Wolf, "Principles of Optics"; Radiance's manual "The Radiance 6.x Scene
// Description Language".
#include <array>

#include "core/material/argument_checks.h"
#include "core/material/fresnel.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"

namespace lightwalk {
namespace {

constexpr double kUsualIndex = 1.52;
constexpr double kNormalReflectance = 0.08;  ///< of a pane of the usual index, both sides
constexpr double kDarkest = 1e-15;  ///< transmissivity of a channel of a pane that transmits at all

class Glass final : public Modifier {
  public:
    explicit Glass(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override {
        return {.transparent = true, .appearance = Appearance::pane, .gloss = kNormalReflectance};
    }

  private:
    [[nodiscard]] std::array<double, 3> internal(double cosine_inside) const;
    void add_transmitted(Ray& ray, bool perturbed, const Rgb& coef, TraceContext& context) const;
    void add_reflected(Ray& ray, bool perturbed, const PerturbedNormal& facing, const Rgb& coef,
                       TraceContext& context) const;

    ModifierId next_;
    double index_ = kUsualIndex;
    bool transmits_;
    bool grey_;                             ///< all channels alike
    std::array<double, 3> raw_{};           ///< transmissivity as given
    std::array<double, 3> log_internal_{};  ///< its logarithm, at normal incidence
};

Glass::Glass(const ModifierBuild& build) : next_(build.next) {
    const Primitive& primitive = build.primitive;
    if (primitive.reals.size() != 3)
        require_exact_reals(primitive, primitive.reals.size() < 3 ? 3 : 4);
    if (primitive.reals.size() == 4) index_ = primitive.reals[3];
    require_index(primitive, index_);
    for (std::size_t i = 0; i < 3; ++i) {
        raw_[i] = primitive.reals[i];
        log_internal_[i] = std::log(std::max(raw_[i], kDarkest));
    }
    transmits_ = std::max({raw_[0], raw_[1], raw_[2]}) > kDarkest;
    grey_ = raw_[0] == raw_[1] && raw_[1] == raw_[2];
}

/// What one crossing at this inner angle leaves of the light, by channel: tn^(1/cosθ).
std::array<double, 3> Glass::internal(double cosine_inside) const {
    if (!transmits_) return raw_;
    std::array<double, 3> left{};
    left[0] = std::exp(log_internal_[0] / cosine_inside);
    left[1] = grey_ ? left[0] : std::exp(log_internal_[1] / cosine_inside);
    left[2] = grey_ ? left[0] : std::exp(log_internal_[2] / cosine_inside);
    return left;
}

bool Glass::shade(Ray& ray, TraceContext& context) const {
    if (ray.hit.cos_out <= 0 && !context.tracer.options().back_faces_visible) {
        context.tracer.pass_through(ray, context);
        return true;
    }
    const bool shadow = ray.in(kShadow);
    if (shadow && !transmits_) return true;
    context.tracer.apply_textures(ray, next_, context);
    if (ray.hit.cos_out < 0) flip_surface(ray);
    const bool perturbed = ray.perturbed();
    const PerturbedNormal facing = textured_normal(ray, perturbed);

    const double inside = cosine_in_pane(facing.cosine, index_);
    const std::array<double, 3> left = internal(inside);
    const PolarizedReflectance r = fresnel(facing.cosine, inside, index_);
    if (transmits_) {
        Rgb coef;
        for (std::size_t i = 0; i < 3; ++i) {
            coef[i] = static_cast<float>(0.5 * (pane_transmittance(r.perpendicular, left[i]) +
                                                pane_transmittance(r.parallel, left[i])));
        }
        add_transmitted(ray, perturbed, coef * ray.pattern, context);
    }
    if (shadow) return true;
    Rgb coef;
    for (std::size_t i = 0; i < 3; ++i) {
        coef[i] = static_cast<float>(0.5 * (pane_reflectance(r.perpendicular, left[i]) +
                                            pane_reflectance(r.parallel, left[i])));
    }
    add_reflected(ray, perturbed, facing, coef, context);
    return true;
}

void Glass::add_transmitted(Ray& ray, bool perturbed, const Rgb& coef,
                            TraceContext& context) const {
    Ray child;
    if (!context.tracer.spawn(child, kTransferred, ray, &coef)) return;
    const bool straight = !perturbed || ray.in(kShadow | kAmbient);
    child.direction = ray.direction;
    if (!straight && !is_phong_hit(ray, context)) {
        child.direction = normalize(ray.direction + ray.hit.perturbation * (2 * (1 - index_)));
    }
    context.tracer.trace(child, context);
    LightTransport::accumulate(ray, child);
    if (straight) ray.unreflected_path_length = ray.hit.t + child.effective_distance();
}

void Glass::add_reflected(Ray& ray, bool perturbed, const PerturbedNormal& facing, const Rgb& coef,
                          TraceContext& context) const {
    Ray child;
    if (!context.tracer.spawn(child, kReflected, ray, &coef)) return;
    child.direction = mirror_direction(ray.direction, facing.normal, facing.cosine);
    context.tracer.trace(child, context);
    const Rgb contribution = LightTransport::accumulate(ray, child);
    note_mirrored(ray, child, contribution,
                  (!perturbed || ray.in(kAmbient)) && is_flat_hit(ray, context));
}

}  // namespace

std::unique_ptr<const Modifier> make_glass(const ModifierBuild& build) {
    return std::make_unique<Glass>(build);
}

}  // namespace lightwalk
