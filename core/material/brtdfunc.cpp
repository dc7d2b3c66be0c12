// BRTDfunc: reflection and transmission, mirror-like, directional and diffuse, all given by the
// user. Source: Radiance's manual "The Radiance 6.x Scene Description Language".
#include <array>

#include "core/material/argument_checks.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"
#include "core/texture/function_binding.h"

namespace lightwalk {
namespace {

constexpr std::size_t kFile = 9;  ///< string argument that names the function file
constexpr std::size_t kNone = static_cast<std::size_t>(-1);  ///< a channel that is "0"
using ChannelOutputs = std::array<std::size_t, 3>;

/// What is compiled, each text once, and which output each channel reads.
struct Requests {
    std::vector<ExpressionRequest> list;
    ChannelOutputs reflected{}, transmitted{}, directional{};

    explicit Requests(const ModifierBuild& build) {
        require_least_strings(build.primitive, kFile + 1);
        const std::vector<std::string>& s = build.primitive.strings;
        for (std::size_t i = 0; i < 3; ++i) {
            reflected[i] = output(s[i], -1);
            transmitted[i] = output(s[3 + i], -1);
            directional[i] = output(s[6 + i], 4);
        }
    }

  private:
    std::size_t output(const std::string& text, int parameters) {
        if (text == "0") return kNone;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (list[i].text == text && list[i].parameters == parameters) return i;
        }
        list.push_back({text, parameters});
        return list.size() - 1;
    }
};

bool any(const ChannelOutputs& outputs) {
    return std::any_of(outputs.begin(), outputs.end(), [](std::size_t o) { return o != kNone; });
}

/// What one hit makes of the material; everything faces the viewer.
struct BrtdShading {
    MaterialVariables variables;  ///< normal, cosine, pattern
    Vec3 perturbation;
    Rgb reflected, transmitted;  ///< diffuse reflectance of this side, diffuse transmittance
    bool perturbed = false, flat = false;
};

class BrtdFunction final : public Modifier {
  public:
    explicit BrtdFunction(const ModifierBuild& build) : BrtdFunction(build, Requests(build)) {}
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override {
        return {.transparent = any(transmitted_), .blocks_shadow_rays = !any(transmitted_)};
    }

  private:
    BrtdFunction(const ModifierBuild& build, Requests requests);
    [[nodiscard]] BrtdShading prepare(const Ray& ray, const TraceContext& context) const;
    [[nodiscard]] std::optional<Rgb> coefficient(const ChannelOutputs& outputs, const Ray& ray,
                                                 const BrtdShading& s, TraceContext& context) const;
    void add_transmitted(Ray& ray, const BrtdShading& s, TraceContext& context) const;
    void add_reflected(Ray& ray, const BrtdShading& s, TraceContext& context) const;
    [[nodiscard]] Rgb direct(const Ray& ray, const BrtdShading& s, const Vec3& wi, double omega,
                             TraceContext& context) const;
    [[nodiscard]] Rgb directional(const Ray& ray, const BrtdShading& s, const Vec3& wi,
                                  double omega, TraceContext& context) const;
    void warn(TraceContext& context) const;

    ModifierId next_;
    std::string name_;
    ChannelOutputs reflected_, transmitted_, directional_;
    FunctionBinding binding_;
    Rgb front_, back_, through_;  ///< diffuse reflectances and transmittance
    bool directional_first_;      ///< the first directional function is not 0
};

BrtdFunction::BrtdFunction(const ModifierBuild& build, Requests requests)
    : next_(build.next),
      name_(build.primitive.name),
      reflected_(requests.reflected),
      transmitted_(requests.transmitted),
      directional_(requests.directional),
      binding_((require_least_reals(build.primitive, 9), build), kFile, std::move(requests.list),
               kFile + 1, kNormalChannels),
      front_(color_argument(build.primitive)),
      back_(color_argument(build.primitive, 3)),
      through_(color_argument(build.primitive, 6)),
      directional_first_(build.primitive.strings[6].empty() ||
                         build.primitive.strings[6][0] != '0') {}

void BrtdFunction::warn(TraceContext& context) const {
    context.warnings.warn("BRTDfunc \"" + name_ + "\": its distribution cannot be computed here");
}

bool BrtdFunction::shade(Ray& ray, TraceContext& context) const {
    const LightTransport& tracer = context.tracer;
    tracer.apply_textures(ray, next_, context);
    const BrtdShading s = prepare(ray, context);
    if (any(transmitted_)) add_transmitted(ray, s, context);
    if (ray.in(kShadow)) return true;
    if (any(reflected_)) add_reflected(ray, s, context);
    constexpr auto kTiny = static_cast<float>(kEpsilon);
    const bool diffuse_reflection = max_component(s.reflected) > kTiny;
    const bool diffuse_transmission = max_component(s.transmitted) > kTiny;
    const Vec3 n = s.variables.normal;
    if (diffuse_reflection) ray.value += tracer.ambient(ray, s.reflected, n, context);
    if (diffuse_transmission) ray.value += tracer.ambient(ray, s.transmitted, -n, context);
    if (!diffuse_reflection && !diffuse_transmission && !directional_first_) return true;
    tracer.add_direct(ray, one_by_one([&](const Vec3& wi, double omega) {
                          return direct(ray, s, wi, omega, context);
                      }),
                      context);
    return true;
}

BrtdShading BrtdFunction::prepare(const Ray& ray, const TraceContext& context) const {
    const bool front = ray.hit.cos_out > 0;
    BrtdShading s;
    s.perturbed = ray.perturbed();
    s.flat = is_flat_hit(ray, context);
    PerturbedNormal facing = textured_normal(ray, s.perturbed);
    s.perturbation = ray.hit.perturbation;
    if (!front) {
        facing = {-facing.normal, -facing.cosine};
        s.perturbation = -s.perturbation;
    }
    s.variables = {facing.normal, facing.cosine, ray.pattern, {}};
    s.reflected = (front ? front_ : back_) * ray.pattern;
    s.transmitted = through_ * ray.pattern;
    return s;
}

/// Three expressions as a colour; nothing after a numeric error.
std::optional<Rgb> BrtdFunction::coefficient(const ChannelOutputs& outputs, const Ray& ray,
                                             const BrtdShading& s, TraceContext& context) const {
    EvalState& state = binding_.begin(ray, context, &s.variables);
    Rgb color;
    for (std::size_t i = 0; i < 3; ++i) {
        if (outputs[i] == kNone) continue;
        const bool known = i > 0 && outputs[i] == outputs[i - 1];
        color[i] = known ? color[i - 1] : static_cast<float>(binding_.evaluate(outputs[i], state));
    }
    if (state.error == EvalError::none) return color;
    warn(context);
    return std::nullopt;
}

void BrtdFunction::add_transmitted(Ray& ray, const BrtdShading& s, TraceContext& context) const {
    const std::optional<Rgb> coef = coefficient(transmitted_, ray, s, context);
    Ray child;
    if (!coef || !context.tracer.spawn(child, kTransferred, ray, &*coef)) return;
    const bool straight = !s.perturbed || ray.in(kShadow | kAmbient);
    child.direction = ray.direction;
    if (!straight && !is_phong_hit(ray, context)) {
        child.direction = normalize(ray.direction - s.perturbation);
    }
    context.tracer.trace(child, context);
    LightTransport::accumulate(ray, child);
    if (straight && brightness(s.transmitted) + brightness(s.reflected) < 1) {
        ray.unreflected_path_length = ray.hit.t + child.effective_distance();
    }
}

void BrtdFunction::add_reflected(Ray& ray, const BrtdShading& s, TraceContext& context) const {
    const std::optional<Rgb> coef = coefficient(reflected_, ray, s, context);
    Ray child;
    if (!coef || !context.tracer.spawn(child, kReflected, ray, &*coef)) return;
    child.direction = mirror_direction(ray.direction, s.variables.normal, s.variables.cosine);
    context.tracer.trace(child, context);
    const Rgb contribution = LightTransport::accumulate(ray, child);
    note_mirrored(ray, child, contribution, s.flat && (!s.perturbed || ray.in(kAmbient)));
}

Rgb BrtdFunction::direct(const Ray& ray, const BrtdShading& s, const Vec3& wi, double omega,
                         TraceContext& context) const {
    const double cos_i = dot(s.variables.normal, wi);
    if (std::fabs(cos_i) <= kEpsilon) return {};
    const double projected = std::fabs(cos_i) * omega;
    Rgb sum = (cos_i > 0 ? s.reflected : s.transmitted) * static_cast<float>(projected / kPi);
    if (any(directional_))
        sum += directional(ray, s, wi, omega, context) * static_cast<float>(projected);
    return sum;
}

/// The given BRDF or BTDF [1/sr] for a light.
Rgb BrtdFunction::directional(const Ray& ray, const BrtdShading& s, const Vec3& wi, double omega,
                              TraceContext& context) const {
    const Vec3 local = binding_.to_function(wi, ray, context);
    const std::array<double, 4> light{local.x, local.y, local.z, omega};
    EvalState& state = binding_.begin(ray, context, &s.variables);
    Rgb f;
    for (std::size_t i = 0; i < 3; ++i) {
        if (directional_[i] == kNone) continue;
        const bool known = i > 0 && directional_[i] == directional_[i - 1];
        f[i] = known ? f[i - 1] : static_cast<float>(binding_.call(directional_[i], light, state));
    }
    if (state.error != EvalError::none) {
        warn(context);
        return {};
    }
    return static_cast<double>(brightness(f)) > kEpsilon ? f : Rgb{};
}

}  // namespace

std::unique_ptr<const Modifier> make_brtdfunc(const ModifierBuild& build) {
    return std::make_unique<BrtdFunction>(build);
}

}  // namespace lightwalk
