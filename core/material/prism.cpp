// prism1, prism2: a sheet that sends light on in one or two directions given by expressions.
// Source: Radiance's manual "The Radiance 6.x Scene Description Language".
#include <array>

#include "core/light/light_sources.h"
#include "core/material/argument_checks.h"
#include "core/material/surface_side.h"
#include "core/scene/modifier.h"
#include "core/texture/function_binding.h"
#include "core/virtual_source/redirecting_modifier.h"

namespace lightwalk {
namespace {

constexpr std::size_t kExpressions = 4;  ///< in each branch: coefficient and direction

class Prism final : public Modifier, public RedirectingModifier {
  public:
    explicit Prism(const ModifierBuild& build);
    [[nodiscard]] bool shade(Ray& ray, TraceContext& context) const override;
    [[nodiscard]] MaterialTraits traits() const override { return {.blocks_shadow_rays = true}; }
    [[nodiscard]] int branches() const override { return branches_; }
    [[nodiscard]] std::optional<Redirection> redirect(int branch, const Ray& hit_ray,
                                                      TraceContext& context) const override;

  private:
    [[nodiscard]] std::optional<Redirection> evaluate(int branch, const Ray& ray, const Vec3& aim,
                                                      TraceContext& context) const;
    void send(Ray& ray, int branch, const Vec3& aim, std::int32_t target,
              TraceContext& context) const;

    int branches_;
    std::string name_;
    FunctionBinding binding_;
};

int branches_of(const ModifierBuild& build) {
    return build.primitive.type == PrimitiveType::prism1 ? 1 : 2;
}

FunctionBinding bind_prism(const ModifierBuild& build) {
    const std::size_t file = kExpressions * static_cast<std::size_t>(branches_of(build));
    require_least_strings(build.primitive, file + 1);
    std::vector<ExpressionRequest> requests;
    for (std::size_t i = 0; i < file; ++i) requests.push_back({build.primitive.strings[i], -1});
    return FunctionBinding(build, file, std::move(requests), file + 1, kAimChannels);
}

Prism::Prism(const ModifierBuild& build)
    : branches_(branches_of(build)), name_(build.primitive.name), binding_(bind_prism(build)) {}

/// Unit direction from a point to a light source.
Vec3 direction_to(const LightSource& source, const Vec3& point) {
    return normalize(source.is_distant() ? source.center : source.center - point);
}

bool Prism::shade(Ray& ray, TraceContext& context) const {
    if (ray.target == kNoTarget) {
        for (int branch = 0; branch < branches_; ++branch)
            send(ray, branch, {}, kNoTarget, context);
        return true;
    }
    const LightSources& lights = context.tracer.lights();
    const LightSource& target = lights[ray.target];
    if (!target.is_virtual() || target.object != ray.hit.surface)
        return true;  // blocks light of others
    send(ray, target.branch, direction_to(lights[target.parent], ray.hit.position), target.parent,
         context);
    return true;
}

std::optional<Redirection> Prism::redirect(int branch, const Ray& hit_ray,
                                           TraceContext& context) const {
    return evaluate(branch, hit_ray, {}, context);
}

std::optional<Redirection> Prism::evaluate(int branch, const Ray& ray, const Vec3& aim,
                                           TraceContext& context) const {
    MaterialVariables variables;
    variables.aim = aim;
    EvalState& state = binding_.begin(ray, context, &variables);
    std::array<double, kExpressions> value{};
    for (std::size_t i = 0; i < kExpressions; ++i) {
        value[i] = binding_.evaluate(kExpressions * static_cast<std::size_t>(branch) + i, state);
        if (state.error != EvalError::none) {
            context.warnings.warn("prism \"" + name_ + "\": its direction cannot be computed here");
            return std::nullopt;
        }
    }
    return Redirection{value[0], binding_.to_world({value[1], value[2], value[3]}, ray, context)};
}

void Prism::send(Ray& ray, int branch, const Vec3& aim, std::int32_t target,
                 TraceContext& context) const {
    const std::optional<Redirection> bent = evaluate(branch, ray, aim, context);
    if (!bent) return;
    const Rgb coef = Rgb::grey(static_cast<float>(bent->coefficient));
    Ray child;
    if (!context.tracer.spawn(child, kTransferred, ray, &coef)) return;
    child.direction = normalize(bent->direction);
    if (child.direction == Vec3{}) return;
    child.target = target;
    context.tracer.trace(child, context);
    LightTransport::accumulate(ray, child);
    if (is_flat_hit(ray, context))
        ray.unreflected_path_length = ray.hit.t + child.effective_distance();
}

}  // namespace

std::unique_ptr<const Modifier> make_prism(const ModifierBuild& build) {
    return std::make_unique<Prism>(build);
}

}  // namespace lightwalk
