// mirror: a flat reflector; light sources seen in it are sources themselves (virtual ones).
// Source: Radiance's manual "The Radiance 6.x Scene Description Language".
#include "core/light/light_sources.h"
#include "core/material/argument_checks.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"

namespace lightwalk {
namespace {

class Mirror final : public Modifier {
  public:
    explicit Mirror(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override {
        return {.blocks_shadow_rays = !has_alternate_,
                .appearance = has_alternate_ ? Appearance::another : Appearance::mirror,
                .gloss = 1,
                .seen = alternate_};
    }

  private:
    [[nodiscard]] bool takes_alternate(const Ray& ray) const;
    void reflect(Ray& ray, const LightSource* redirected, TraceContext& context) const;

    ModifierId next_;
    Rgb color_;
    bool has_alternate_;
    ModifierId alternate_ = kVoid;  ///< what the eye sees instead
    bool transparent_alternate_ = false;
};

Mirror::Mirror(const ModifierBuild& build)
    : next_(build.next), has_alternate_(!build.primitive.strings.empty()) {
    require_exact_reals(build.primitive, 3);
    require_most_strings(build.primitive, 1);
    color_ = color_argument(build.primitive);
    alternate_ = alternate_of(build);
    transparent_alternate_ = alternate_ != kVoid && build.is_transparent(alternate_);
}

/// Paths whose light the virtual sources do not bring already see the alternate; so do others that
/// only look through it.
bool Mirror::takes_alternate(const Ray& ray) const {
    return ray.hit.cos_out < 0 || !ray.in(kAmbient | kSpecular) || transparent_alternate_;
}

bool Mirror::shade(Ray& ray, TraceContext& context) const {
    const LightTransport& tracer = context.tracer;
    const LightSource* redirected = nullptr;  // the virtual source of this very mirror
    if (ray.target != kNoTarget) {
        const LightSource& target = tracer.lights()[ray.target];
        if (target.is_virtual() && target.object == ray.hit.surface) redirected = &target;
    }
    if (has_alternate_ && !redirected && takes_alternate(ray)) {
        if (alternate_ != kVoid) return tracer.shade_chain(ray, alternate_, context);
        tracer.pass_through(ray, context);
        return true;
    }
    if (ray.target != kNoTarget && !redirected) return true;  // blocks light of others
    if (ray.hit.cos_out < 0) {
        if (!tracer.options().back_faces_visible) tracer.pass_through(ray, context);
        return true;
    }
    tracer.apply_textures(ray, next_, context);
    reflect(ray, redirected, context);
    return true;
}

void Mirror::reflect(Ray& ray, const LightSource* redirected, TraceContext& context) const {
    const Rgb coef = color_ * ray.pattern;
    Ray child;
    if (!context.tracer.spawn(child, kReflected, ray, &coef)) return;
    bool textured = !redirected && ray.perturbed() && !ray.in(kAmbient);
    if (textured) {
        const PerturbedNormal facing = perturb_normal(ray);
        child.direction = mirror_direction(ray.direction, facing.normal, facing.cosine);
        textured = dot(child.direction, ray.hit.normal) > kEpsilon;
    }
    if (!textured)
        child.direction = mirror_direction(ray.direction, ray.hit.normal, ray.hit.cos_out);
    if (redirected) child.target = redirected->parent;
    context.tracer.trace(child, context);
    const Rgb contribution = LightTransport::accumulate(ray, child);
    note_mirrored(ray, child, contribution, !textured && is_flat_hit(ray, context));
}

}  // namespace

std::unique_ptr<const Modifier> make_mirror(const ModifierBuild& build) {
    return std::make_unique<Mirror>(build);
}

}  // namespace lightwalk
