// light, illum, glow, spotlight: what a ray sees that hits a light source. Light that the direct
// calculation brings must not be counted again by paths that find the source by chance. Source:
// Radiance's manual "The Radiance 6.x Scene Description Language".
#include "core/light/light_sources.h"
#include "core/light/spot.h"
#include "core/material/argument_checks.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"
#include "core/transport/contribution.h"

namespace lightwalk {
namespace {

class Light final : public Modifier {
  public:
    explicit Light(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override {
        return {.blocks_shadow_rays = type_ != PrimitiveType::illum,
                .clear_from_behind = type_ == PrimitiveType::illum && alternate_ == kVoid,
                .appearance = appearance(),
                .seen = alternate_};
    }

  private:
    [[nodiscard]] Appearance appearance() const;
    [[nodiscard]] bool far_glow(double distance) const;
    [[nodiscard]] bool misses(const Ray& ray, const LightSource* target) const;
    [[nodiscard]] bool shade_alternate(Ray& ray, TraceContext& context) const;
    [[nodiscard]] Rgb emission(Ray& ray, TraceContext& context) const;

    PrimitiveType type_;
    ModifierId next_;
    Rgb color_;
    double influence_ = 0;          ///< glow: radius of influence [m]
    ModifierId alternate_ = kVoid;  ///< illum: what the eye sees instead
    SpotShape cone_;                ///< spotlight
};

Light::Light(const ModifierBuild& build) : type_(build.primitive.type), next_(build.next) {
    const Primitive& primitive = build.primitive;
    const bool spot = type_ == PrimitiveType::spotlight;
    require_exact_reals(primitive, spot ? 7 : type_ == PrimitiveType::glow ? 4 : 3);
    color_ = color_argument(primitive);
    if (type_ == PrimitiveType::glow) influence_ = primitive.reals[3];
    if (type_ == PrimitiveType::illum) alternate_ = alternate_of(build);
    if (spot) cone_ = spot_cone(primitive);
}

Appearance Light::appearance() const {
    if (type_ == PrimitiveType::illum) return Appearance::another;
    return type_ == PrimitiveType::spotlight ? Appearance::unknown : Appearance::constant;
}

/// A glow that does not light what is so far away; it is seen by every ray instead.
bool Light::far_glow(double distance) const {
    return type_ == PrimitiveType::glow && influence_ >= -kEpsilon && distance > influence_;
}

/// Whether a shadow ray that is on its way to another source ends here.
bool Light::misses(const Ray& ray, const LightSource* target) const {
    if (!target || target->object == ray.hit.surface) return false;
    if (type_ != PrimitiveType::illum) return true;
    return !target->is_virtual() && ray.hit.cos_out > 0 &&
           (target->material_type == PrimitiveType::illum ||
            target->material_type == PrimitiveType::glow);
}

bool Light::shade_alternate(Ray& ray, TraceContext& context) const {
    if (alternate_ != kVoid) return context.tracer.shade_chain(ray, alternate_, context);
    context.tracer.pass_through(ray, context);
    return true;
}

bool Light::shade(Ray& ray, TraceContext& context) const {
    const LightTransport& tracer = context.tracer;
    const LightSource* target = ray.target == kNoTarget ? nullptr : &tracer.lights()[ray.target];
    const bool by_chance = ray.in(kAmbient | kSpecular) && !ray.in(kShadow) && ray.hit.cos_out >= 0;
    if ((by_chance && !far_glow(ray.hit.t)) || misses(ray, target)) {
        ray.coef = {};
        return true;
    }
    if (type_ == PrimitiveType::illum &&
        (!target || target->object != ray.hit.surface || target->is_virtual())) {
        return shade_alternate(ray, context);
    }
    if (!tracer.options().sources_visible && !ray.in(kShadow) &&
        !far_glow(ray.path_length + ray.hit.t)) {
        ray.coef = {};
        return true;
    }
    if (ray.hit.cos_out < 0 && !tracer.options().back_faces_visible) {
        tracer.pass_through(ray, context);
        return true;
    }
    ray.value = emission(ray, context);
    // Where it sends nothing, too: the coefficient is asked for.
    if (context.contributions) tell_emission(ray, *context.contributions);
    return true;
}

/// Le towards the ray's origin [W/(m² sr)].
Rgb Light::emission(Ray& ray, TraceContext& context) const {
    if (ray.hit.cos_out < 0) return {};
    if (type_ == PrimitiveType::spotlight && outside_spot(cone_, ray.origin, ray.direction))
        return {};
    context.tracer.apply_textures(ray, next_, context);
    return color_ * ray.pattern;
}

}  // namespace

std::unique_ptr<const Modifier> make_light(const ModifierBuild& build) {
    return std::make_unique<Light>(build);
}

}  // namespace lightwalk
