// plasfunc, metfunc, transfunc, plasdata, metdata, transdata: a diffuse sheet whose highlight is a
// function of the light's direction, or of a table looked up there. Only lights make highlights:
// nothing is sampled. Source: Radiance's manual "The Radiance 6.x Scene Description Language".
#include <array>

#include "core/material/argument_checks.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"
#include "core/texture/arguments.h"
#include "core/texture/function_binding.h"
#include "core/texture/interpolate.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMaxDimensions = 6;
constexpr std::size_t kLightParameters = 4;  ///< lx, ly, lz, omega

/// A lobe [1/sr] as the arguments give it: `function [data] file [coordinates] transform`.
class LobeFunction {
  public:
    explicit LobeFunction(const ModifierBuild& build) : binding_(bind(build, table_)) {}
    /// Value for a light in direction wi (world); nothing after a numeric error.
    [[nodiscard]] std::optional<double> value(const Ray& ray, const MaterialVariables& variables,
                                              const Vec3& wi, double omega,
                                              TraceContext& context) const;

  private:
    static FunctionBinding bind(const ModifierBuild& build,
                                std::shared_ptr<const DataArray>& table);

    std::shared_ptr<const DataArray> table_;  ///< none for the *func types
    FunctionBinding binding_;                 ///< outputs: the function, then the coordinates
};

bool is_tabulated(PrimitiveType type) {
    return type == PrimitiveType::plasdata || type == PrimitiveType::metdata ||
           type == PrimitiveType::transdata;
}

FunctionBinding LobeFunction::bind(const ModifierBuild& build,
                                   std::shared_ptr<const DataArray>& table) {
    const Primitive& primitive = build.primitive;
    const std::vector<std::string>& s = primitive.strings;
    if (!is_tabulated(primitive.type)) {
        require_least_strings(primitive, 2);
        return FunctionBinding(build, 1, {{s[0], static_cast<int>(kLightParameters)}}, 2,
                               kNormalChannels);
    }
    require_least_strings(primitive, 4);
    table = load_for(primitive, [&] { return build.resources.data(s[1]); });
    const std::size_t dimensions = table->axes.size();
    if (dimensions > kMaxDimensions)
        throw modifier_error(primitive, "too many dimensions in data file");
    require_least_strings(primitive, 3 + dimensions);
    std::vector<ExpressionRequest> requests{{s[0], static_cast<int>(kLightParameters) + 1}};
    for (std::size_t d = 0; d < dimensions; ++d) {
        requests.push_back({s[3 + d], static_cast<int>(kLightParameters)});
    }
    return FunctionBinding(build, 2, std::move(requests), 3 + dimensions, kNormalChannels);
}

std::optional<double> LobeFunction::value(const Ray& ray, const MaterialVariables& variables,
                                          const Vec3& wi, double omega,
                                          TraceContext& context) const {
    const Vec3 local = binding_.to_function(wi, ray, context);
    // The datum comes before the light's parameters; the functions of the direction alone get those
    // only.
    std::array<double, kLightParameters + 1> arguments{0, local.x, local.y, local.z, omega};
    const std::span<const double> light(arguments.data() + 1, kLightParameters);
    EvalState& state = binding_.begin(ray, context, &variables);
    double result = 0;
    if (table_) {
        std::array<double, kMaxDimensions> point{};
        const std::size_t dimensions = table_->axes.size();
        for (std::size_t d = 0; d < dimensions; ++d) point[d] = binding_.call(1 + d, light, state);
        if (state.error != EvalError::none) return std::nullopt;
        arguments[0] = interpolate(*table_, std::span<const double>(point.data(), dimensions));
        result = binding_.call(0, arguments, state);
    } else {
        result = binding_.call(0, light, state);
    }
    if (state.error != EvalError::none) return std::nullopt;
    return result;
}

class FunctionBrdf final : public Modifier {
  public:
    explicit FunctionBrdf(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override { return {.blocks_shadow_rays = true}; }

  private:
    [[nodiscard]] Rgb direct(const Ray& ray, const MaterialVariables& variables, const Vec3& wi,
                             double omega, TraceContext& context) const;

    PrimitiveType type_;
    ModifierId next_;
    std::string name_;
    LobeFunction lobe_;
    Rgb color_;
    double rho_, rho_d_;                      ///< specular and diffuse reflectance
    double tau_ = 0, tau_s_ = 0, tau_d_ = 0;  ///< transmittance, its specular and diffuse parts
    bool colored_reflection_, colored_transmission_;
};

bool transmits(PrimitiveType type) {
    return type == PrimitiveType::transfunc || type == PrimitiveType::transdata;
}

FunctionBrdf::FunctionBrdf(const ModifierBuild& build)
    : type_(build.primitive.type),
      next_(build.next),
      name_(build.primitive.name),
      lobe_((require_least_reals(build.primitive, transmits(build.primitive.type) ? 6 : 4), build)),
      color_(color_argument(build.primitive)),
      rho_(build.primitive.reals[3]),
      colored_reflection_(type_ == PrimitiveType::metfunc || type_ == PrimitiveType::metdata),
      colored_transmission_(transmits(type_)) {
    if (transmits(type_)) {
        tau_ = build.primitive.reals[4] * (1 - rho_);
        tau_s_ = tau_ * build.primitive.reals[5];
        tau_d_ = tau_ - tau_s_;
    }
    rho_d_ = 1 - tau_ - rho_;
}

bool FunctionBrdf::shade(Ray& ray, TraceContext& context) const {
    if (ray.in(kShadow)) return true;
    if (!turn_to_viewer(ray, next_, context)) return true;
    const LightTransport& tracer = context.tracer;
    const PerturbedNormal facing = perturb_normal(ray);
    const MaterialVariables variables{facing.normal, facing.cosine, color_ * ray.pattern, {}};
    if (tau_ < 1 - kEpsilon) {
        const Rgb coef = variables.color * static_cast<float>(1 - tau_);
        ray.value += tracer.ambient(ray, coef, facing.normal, context);
    }
    if (tau_ > kEpsilon) {
        const Rgb coef = variables.color * static_cast<float>(tau_);
        ray.value += tracer.ambient(ray, coef, -facing.normal, context);
    }
    tracer.add_direct(ray, one_by_one([&](const Vec3& wi, double omega) {
                          return direct(ray, variables, wi, omega, context);
                      }),
                      context);
    return true;
}

Rgb FunctionBrdf::direct(const Ray& ray, const MaterialVariables& variables, const Vec3& wi,
                         double omega, TraceContext& context) const {
    const double cos_i = dot(variables.normal, wi);
    if (std::fabs(cos_i) <= kEpsilon) return {};
    if (cos_i < 0 ? tau_ <= kEpsilon : tau_ >= 1 - kEpsilon) return {};
    const double diffuse = cos_i > 0 ? rho_d_ : tau_d_;
    const double specular = cos_i > 0 ? rho_ : tau_s_;
    const double projected = std::fabs(cos_i) * omega;
    Rgb sum;
    if (diffuse > kEpsilon) sum = variables.color * static_cast<float>(diffuse * projected / kPi);
    if (specular <= kEpsilon) return sum;
    const std::optional<double> lobe = lobe_.value(ray, variables, wi, omega, context);
    if (!lobe) {
        context.warnings.warn(std::string(to_string(type_)) + " \"" + name_ +
                              "\": its distribution cannot be computed here");
        return sum;
    }
    if (*lobe > kEpsilon) {
        const auto share = static_cast<float>(*lobe * specular * projected);
        const bool colored = cos_i > 0 ? colored_reflection_ : colored_transmission_;
        sum += colored ? variables.color * share : Rgb::grey(share);
    }
    return sum;
}

}  // namespace

std::unique_ptr<const Modifier> make_function_brdf(const ModifierBuild& build) {
    return std::make_unique<FunctionBrdf>(build);
}

}  // namespace lightwalk
