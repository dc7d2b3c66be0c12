// BSDF, aBSDF: scattering by a thin or thick system as a file of measured or computed data has it.
// Sources: Radiance's manual "The Radiance 6.x Scene Description Language"; Ward, Mistrick, Lee,
// McNeil & Jonsson, "Simulating the daylight performance of complex fenestration systems using
// bidirectional scattering distribution functions within Radiance", Leukos 7(4) (2011).
#include <algorithm>
#include <optional>

#include "core/material/argument_checks.h"
#include "core/material/bsdf_hit.h"
#include "core/material/surface_side.h"
#include "core/model/transform_args.h"
#include "core/scene/modifier.h"
#include "core/texture/arguments.h"
#include "core/texture/function_binding.h"

namespace lightwalk {
namespace {

/// How far a system reaches from its surface, and its up direction.
struct BsdfPlacement {
    double thickness = 0;  ///< [m]; 0: none
    Vec3 up;
};

class BsdfMaterial final : public Modifier {
  public:
    explicit BsdfMaterial(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override;
    [[nodiscard]] const Bsdf* bsdf() const override { return bsdf_.get(); }

  private:
    static FunctionBinding bind(const ModifierBuild& build, bool thick);
    [[nodiscard]] BsdfPlacement placement(const Ray& ray, TraceContext& context) const;
    [[nodiscard]] bool is_hidden(const Ray& ray, double thickness) const;
    [[nodiscard]] std::optional<BsdfHit> prepare(Ray& ray, const BsdfPlacement& placed,
                                                 TraceContext& context) const;
    void add_straight(Ray& ray, const BsdfHit& hit, TraceContext& context) const;
    void add_ambient(Ray& ray, const BsdfHit& hit, const UnsampledLobes& left,
                     TraceContext& context) const;
    void add_direct(Ray& ray, const BsdfHit& hit, TraceContext& context) const;

    bool always_thick_ = false;  ///< the thickness is a number other than 0
    bool fixed_up_ = false;      ///< an aBSDF's up vector is three numbers, without a transform
    bool thick_;                 ///< BSDF, whose first string is a thickness; else aBSDF
    ModifierId next_;
    std::string name_;
    std::shared_ptr<const Bsdf> bsdf_;
    FunctionBinding binding_;     ///< outputs: the up direction, then the thickness of a BSDF
    Rgb front_, back_, through_;  ///< Lambertian reflectances and transmittance added to the data
};

/// The eye does not see a surface of a constant thickness; through an aBSDF it sees what lies
/// behind, if anything passes straight along the normal. Where its up vector is computed nothing
/// tells which cell of the data that is seen through.
MaterialTraits BsdfMaterial::traits() const {
    MaterialTraits traits{.transparent = bsdf_->transmits() || max_component(through_) > 0};
    if (always_thick_)
        traits.appearance = Appearance::absent;
    else if (!thick_ && fixed_up_ &&
             find_through_part(bsdf_->transmission(true), ProjectedDirection{}).exists())
        traits.appearance = Appearance::pane;
    return traits;
}

FunctionBinding BsdfMaterial::bind(const ModifierBuild& build, bool thick) {
    const std::vector<std::string>& s = build.primitive.strings;
    const std::size_t up = thick ? 2 : 1;
    std::vector<ExpressionRequest> requests{{s[up], -1}, {s[up + 1], -1}, {s[up + 2], -1}};
    if (thick) requests.push_back({s[0], -1});
    return FunctionBinding(build, up + 3, std::move(requests), up + 4);
}

BsdfMaterial::BsdfMaterial(const ModifierBuild& build)
    : thick_(build.primitive.type == PrimitiveType::bsdf),
      next_(build.next),
      name_(build.primitive.name),
      bsdf_((
          require_least_strings(build.primitive, thick_ ? 6 : 5),
          load_for(build.primitive,
                   [&] { return build.resources.bsdf(build.primitive.strings[thick_ ? 1 : 0]); }))),
      binding_(bind(build, thick_)) {
    const Primitive& primitive = build.primitive;
    const std::size_t reals = primitive.reals.size();
    if (reals > 9 || reals % 3 != 0) require_exact_reals(primitive, reals > 9 ? 9 : reals / 3 * 3);
    if (reals >= 3) front_ = color_argument(primitive);
    if (reals >= 6) back_ = color_argument(primitive, 3);
    if (reals >= 9) through_ = color_argument(primitive, 6);
    double thickness = 0;
    always_thick_ =
        thick_ && parse_real(primitive.strings[0], thickness) && std::abs(thickness) > kEpsilon;
    const std::vector<std::string>& strings = primitive.strings;
    double number = 0;
    fixed_up_ = !thick_ && strings.size() == 5 &&
                std::all_of(strings.begin() + 1, strings.begin() + 4,
                            [&](const std::string& word) { return parse_real(word, number); });
    for (const std::string& warning : bsdf_->warnings()) build.warnings.warn(warning);
}

BsdfPlacement BsdfMaterial::placement(const Ray& ray, TraceContext& context) const {
    EvalState& state = binding_.begin(ray, context);
    const Vec3 up{binding_.evaluate(0, state), binding_.evaluate(1, state),
                  binding_.evaluate(2, state)};
    double thickness = thick_ ? binding_.evaluate(3, state) : 0;
    if (state.error != EvalError::none) {
        context.warnings.warn("the thickness or the up vector of \"" + name_ +
                              "\" cannot be computed here");
        return {};
    }
    if (thickness != 0) {
        thickness *= binding_.transform().size();
        if (ray.hit.instance != kWorld)
            thickness *=
                context.tracer.scene().geometry().instance_transform(ray.hit.instance).size();
    }
    if (std::abs(thickness) <= kEpsilon) thickness = 0;
    return {thickness, binding_.to_world(up, ray, context)};
}

/// Whether a system with geometry of its own, which its surface stands for, is not there for a ray:
/// only scattered light takes the data, and from the side where the geometry does not lie.
bool BsdfMaterial::is_hidden(const Ray& ray, double thickness) const {
    if (thickness == 0) return false;
    const bool behind = thickness > 0 ? ray.hit.cos_out <= 0 : ray.hit.cos_out > 0;
    return ray.in(kShadow) || !ray.in(kSpecular | kAmbient) || behind;
}

bool BsdfMaterial::shade(Ray& ray, TraceContext& context) const {
    if (ray.hit.cos_out < 0 && !context.tracer.options().back_faces_visible) {
        context.tracer.pass_through(ray, context);
        return true;
    }
    const BsdfPlacement placed = placement(ray, context);
    if (is_hidden(ray, placed.thickness)) {
        context.tracer.pass_through(ray, context);
        return true;
    }
    const bool shadow = ray.in(kShadow);
    if (shadow && thick_) return true;  // it stops the light of sources, which it scatters instead
    const std::optional<BsdfHit> hit = prepare(ray, placed, context);
    if (!hit) return true;
    if (shadow || hit->split) add_straight(ray, *hit, context);
    if (shadow) return true;
    const UnsampledLobes left = add_bsdf_samples(ray, *hit, context);
    add_ambient(ray, *hit, left, context);
    add_direct(ray, *hit, context);
    return true;
}

/// Nothing where the data has no orientation: the surface is black there.
std::optional<BsdfHit> BsdfMaterial::prepare(Ray& ray, const BsdfPlacement& placed,
                                             TraceContext& context) const {
    context.tracer.apply_textures(ray, next_, context);
    BsdfFrame frame;
    frame.z = textured_normal(ray, ray.perturbed()).normal;
    const Vec3 across = cross(placed.up, frame.z);
    if (!(length_squared(across) > 0)) {
        context.warnings.warn("BSDF \"" + name_ + "\": illegal orientation vector");
        return std::nullopt;
    }
    frame.x = normalize(across);
    frame.y = cross(frame.z, frame.x);
    BsdfHit hit{*bsdf_,
                frame,
                frame.project(-ray.direction),
                ray.hit.cos_out > 0 ? 1.0 : -1.0,
                ray.pattern,
                {},
                {},
                placed.thickness};
    const bool front = hit.front();
    hit.reflected = (hit.reflection().lambertian + (front ? front_ : back_)) * ray.pattern;
    hit.transmitted = (hit.transmission().lambertian + through_) * ray.pattern;
    const bool shadow = ray.in(kShadow), scattered = ray.in(kSpecular | kAmbient);
    if (!shadow) look_up_viewer(hit);
    if (!thick_ && (shadow || !scattered)) {
        if (!context.through_part) context.through_part = make_opaque<RecentThroughPart>();
        hit.through = shadow ? context.through_part->find(hit.transmission(), hit.e)
                             : find_through_part(hit.transmission(), hit.in_transmission);
        hit.split = hit.through.exists() && max_component(ray.pattern) > 0;
    }
    return hit;
}

void BsdfMaterial::add_straight(Ray& ray, const BsdfHit& hit, TraceContext& context) const {
    if (!hit.split) return;
    const Rgb coef = hit.through.transmittance * hit.pattern;
    Ray child;
    if (!context.tracer.spawn(child, kTransferred, ray, &coef)) return;
    child.direction = ray.direction;
    context.tracer.trace(child, context);
    LightTransport::accumulate(ray, child);
    ray.unreflected_path_length = ray.hit.t + child.effective_distance();
}

void BsdfMaterial::add_ambient(Ray& ray, const BsdfHit& hit, const UnsampledLobes& left,
                               TraceContext& context) const {
    constexpr auto kTiny = static_cast<float>(kEpsilon);
    const Vec3 n = hit.facing();
    const Rgb reflected = hit.reflected + left.reflected,
              transmitted = hit.transmitted + left.transmitted;
    if (max_component(reflected) > kTiny)
        ray.value += context.tracer.ambient(ray, reflected, n, context);
    if (max_component(transmitted) > kTiny) {
        const Vec3 position = ray.hit.position;
        ray.hit.position -= ray.hit.normal * hit.thickness;
        ray.value += context.tracer.ambient(ray, transmitted, -n, context);
        ray.hit.position = position;
    }
}

void BsdfMaterial::add_direct(Ray& ray, const BsdfHit& hit, TraceContext& context) const {
    const LightTransport& tracer = context.tracer;
    const BsdfDirect direct(hit, ray, tracer.options());
    const Vec3 n = hit.facing();
    const bool transmits = hit.transmits();
    if (hit.thickness == 0 || !transmits) {
        tracer.add_direct(
            ray, one_by_one([&](const Vec3& wi, double omega) { return direct(wi, omega); }),
            context, transmits ? nullptr : &n);
        return;
    }
    // Light of either side is gathered where it leaves the system.
    const auto on_side = [&](double side) {
        return one_by_one([&direct, n, side](const Vec3& wi, double omega) {
            return dot(n, wi) * side > 0 ? direct(wi, omega) : Rgb{};
        });
    };
    const Vec3 behind = -n, position = ray.hit.position;
    const auto from_here = on_side(1), from_beyond = on_side(-1);
    tracer.add_direct(ray, from_here, context, &n);
    ray.hit.position -= ray.hit.normal * hit.thickness;
    tracer.add_direct(ray, from_beyond, context, &behind);
    ray.hit.position = position;
}

}  // namespace

std::unique_ptr<const Modifier> make_bsdf(const ModifierBuild& build) {
    return std::make_unique<BsdfMaterial>(build);
}

}  // namespace lightwalk
