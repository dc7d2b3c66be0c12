// dielectric, interface: the boundary between two transparent media, one of them inside a solid.
// Sources: Born & Wolf, "Principles of Optics"; Radiance's manual "The Radiance 6.x Scene
// Description Language".
#include "core/material/argument_checks.h"
#include "core/material/fresnel.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"

namespace lightwalk {
namespace {

/// Extinction [1/m] of a medium that passes `transmission` of the light per unit length.
Rgb extinction_of(const Rgb& transmission) {
    Rgb extinction;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto x = static_cast<double>(transmission[i]);
        if (x < 1e-40)
            extinction[i] = 100;
        else
            extinction[i] = x >= 1 ? 0.0f : static_cast<float>(-std::log(x));
    }
    return extinction;
}

/// What one of the two media does with light that crosses it.
struct Substance {
    Rgb transmission;  ///< per unit length
    Rgb extinction;    ///< per unit length, without a pattern
    [[nodiscard]] Rgb patterned(const Rgb& pattern) const {
        return pattern == Rgb{1, 1, 1} ? extinction : extinction_of(transmission * pattern);
    }
};

Substance substance(const Primitive& primitive, std::size_t first) {
    const Rgb transmission = color_argument(primitive, first);
    return {transmission, extinction_of(transmission)};
}

/// Where a ray crosses the boundary.
struct Crossing {
    double cosine = 1;  ///< of incidence, >= 0
    Vec3 normal;        ///< shading normal on the incident side
    double eta = 1;     ///< index before over index behind
    Medium behind;      ///< medium of the refracted ray
    bool inside = false;
    bool perturbed = false;
};

class Dielectric final : public Modifier {
  public:
    explicit Dielectric(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override { return {.transparent = true}; }

  private:
    [[nodiscard]] Crossing cross_boundary(Ray& ray, const RenderOptions& options) const;
    void add_refracted(Ray& ray, const Crossing& at, const Refraction& r, bool unfold,
                       TraceContext& context) const;
    static void add_reflected(Ray& ray, const Crossing& at, const Refraction& r, bool unfold,
                              TraceContext& context);

    ModifierId next_;
    bool interface_;
    double index_;  ///< inside over outside
    Substance inner_, outer_;
};

Dielectric::Dielectric(const ModifierBuild& build)
    : next_(build.next), interface_(build.primitive.type == PrimitiveType::interface) {
    const Primitive& primitive = build.primitive;
    require_exact_reals(primitive, interface_ ? 8 : 5);
    inner_ = substance(primitive, 0);
    if (interface_) {
        index_ = primitive.reals[3] / primitive.reals[7];
        outer_ = substance(primitive, 4);
    } else {
        index_ =
            primitive.reals[3] + primitive.reals[4] / 500;  // Hartmann's formula in mid-spectrum
    }
    require_index(primitive, index_);
}

bool Dielectric::shade(Ray& ray, TraceContext& context) const {
    context.tracer.apply_textures(ray, next_, context);
    const Crossing at = cross_boundary(ray, context.tracer.options());
    const Refraction r = refract(at.cosine, at.eta);
    const bool unfold = (!at.perturbed || ray.in(kAmbient)) && is_flat_hit(ray, context);
    if (r.cos_t > 0) add_refracted(ray, at, r, unfold, context);
    if (!ray.in(kShadow)) add_reflected(ray, at, r, unfold, context);
    return true;
}

/// The side that the ray is on says what it came through: the segment's medium is set here, too.
Crossing Dielectric::cross_boundary(Ray& ray, const RenderOptions& options) const {
    Crossing at;
    at.perturbed = ray.perturbed();
    const PerturbedNormal facing = textured_normal(ray, at.perturbed);
    const Medium inner{inner_.patterned(ray.pattern), {}, 0, ray.medium.scatter};
    Medium outer{options.extinction, options.albedo, static_cast<float>(options.eccentricity),
                 ray.medium.scatter};
    if (interface_) outer = {outer_.patterned(ray.pattern), {}, 0, ray.medium.scatter};
    at.inside = facing.cosine < 0;
    at.cosine = std::fabs(facing.cosine);
    at.normal = at.inside ? -facing.normal : facing.normal;
    at.eta = at.inside ? index_ : 1 / index_;
    at.behind = at.inside ? outer : inner;
    if (at.inside)
        ray.medium = inner;
    else if (interface_)
        ray.medium = outer;
    return at;
}

void Dielectric::add_refracted(Ray& ray, const Crossing& at, const Refraction& r, bool unfold,
                               TraceContext& context) const {
    const Rgb coef = Rgb::grey(static_cast<float>(r.transmittance));
    Ray child;
    if (!context.tracer.spawn(child, kRefracted, ray, &coef)) return;
    const Vec3 along = ray.direction * at.eta;
    const double down = at.eta * at.cosine - r.cos_t;
    child.direction = normalize(along + at.normal * down);
    if (at.perturbed) {
        const Vec3 facing = at.inside ? -ray.hit.normal : ray.hit.normal;
        if (dot(child.direction, facing) >= -kEpsilon)
            child.direction = normalize(along + facing * down);
    }
    child.medium = at.behind;
    context.tracer.trace(child, context);
    LightTransport::accumulate(ray, child);
    if (unfold || std::fabs(index_ - 1) <= kEpsilon) {
        ray.unreflected_path_length = ray.hit.t + child.effective_distance();
    }
}

void Dielectric::add_reflected(Ray& ray, const Crossing& at, const Refraction& r, bool unfold,
                               TraceContext& context) {
    const Rgb coef = Rgb::grey(static_cast<float>(r.reflectance));
    Ray child;
    if (!context.tracer.spawn(child, kReflected, ray, &coef)) return;
    child.direction = mirror_direction(ray.direction, at.normal, at.cosine);
    if (at.perturbed) {
        const Vec3 facing = at.inside ? -ray.hit.normal : ray.hit.normal;
        if (dot(child.direction, facing) <= kEpsilon) {
            child.direction = mirror_direction(ray.direction, ray.hit.normal, ray.hit.cos_out);
        }
    }
    context.tracer.trace(child, context);
    const Rgb contribution = LightTransport::accumulate(ray, child);
    note_mirrored(ray, child, contribution, unfold);
}

}  // namespace

std::unique_ptr<const Modifier> make_dielectric(const ModifierBuild& build) {
    return std::make_unique<Dielectric>(build);
}

}  // namespace lightwalk
