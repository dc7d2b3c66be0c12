// Mixtures of two modifiers: of materials (radiance is mixed) or of textures and patterns.
#include <cmath>
#include <optional>
#include <variant>

#include "core/scene/modifier.h"
#include "core/texture/arguments.h"
#include "core/texture/lookup.h"
#include "core/texture/text_pattern.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

/// The two modifiers of a mixture and what happens when their results are combined.
struct MixedPair {
    ModifierId fore = kVoid, back = kVoid;
    ModifierId next = kVoid;  ///< the mixture's own modifier
    SourceLocation where;
    std::string name;

    explicit MixedPair(const ModifierBuild& build)
        : fore(resolve(build, 0)),
          back(resolve(build, 1)),
          next(build.next),
          where(build.primitive.where),
          name(build.primitive.name) {}

    static ModifierId resolve(const ModifierBuild& build, std::size_t i) {
        require_arguments(build.primitive, 2);
        if (build.undefined(i)) {
            throw modifier_error(build.primitive,
                                 "undefined modifier \"" + build.primitive.strings[i] + "\"");
        }
        return build.reference(i);
    }

    void require_void_modifier() const {
        if (next == kVoid) return;
        throw InputError(
            where,
            "mixture \"" + name +
                "\": inappropriate modifier: a mixture of materials must have modifier void");
    }
};

Rgb mix(const Rgb& fore, const Rgb& back, float c) {
    return fore * c + back * (1 - c);
}

/// Take over the larger contribution's distances, and the weighted sum of the radiances.
void combine_values(Ray& ray, const Ray& fore, const Ray& back, float c) {
    ray.value = mix(fore.value, back.value, c);
    ray.mirrored = mix(fore.mirrored, back.mirrored, c);
    const float fore_mirrored = c * brightness(fore.mirrored);
    const float back_mirrored = (1 - c) * brightness(back.mirrored);
    ray.reflected_path_length =
        fore_mirrored > back_mirrored ? fore.reflected_path_length : back.reflected_path_length;
    const float fore_rest = c * brightness(fore.value) - fore_mirrored;
    const float back_rest = (1 - c) * brightness(back.value) - back_mirrored;
    ray.unreflected_path_length =
        fore_rest > back_rest ? fore.unreflected_path_length : back.unreflected_path_length;
}

/// Evaluate both branches on copies of the ray. True: at least one was a material.
bool shade_mixed(const MixedPair& pair, double coefficient, Ray& ray, TraceContext& context) {
    const double c = coefficient < 0 ? 0 : coefficient > 1 ? 1 : coefficient;  // NaN stays
    const bool run_fore = c > kEpsilon, run_back = c < 1 - kEpsilon;
    Ray fore = ray, back = ray;
    fore.random = ray.random.child();
    back.random = ray.random.child();
    bool fore_material = false, back_material = false;
    if (run_fore) {
        fore.weight *= c;
        fore.coef *= static_cast<float>(c);
        context.tracer.enter_mixture(
            context, [&] { fore_material = context.tracer.shade_chain(fore, pair.fore, context); });
    }
    if (run_back) {
        back.weight *= 1 - c;
        back.coef *= static_cast<float>(1 - c);
        context.tracer.enter_mixture(
            context, [&] { back_material = context.tracer.shade_chain(back, pair.back, context); });
    }
    if (fore_material != back_material) {
        if (run_fore && !fore_material) context.tracer.pass_through(fore, context);
        if (run_back && !back_material) context.tracer.pass_through(back, context);
    }
    const auto share = static_cast<float>(c);
    ray.hit.perturbation = fore.hit.perturbation * c + back.hit.perturbation * (1 - c);
    ray.pattern = mix(fore.pattern, back.pattern, share);
    if (!fore_material && !back_material) return false;
    pair.require_void_modifier();
    combine_values(ray, fore, back, share);
    return true;
}

class FunctionMixture final : public Modifier {
  public:
    explicit FunctionMixture(const ModifierBuild& build)
        : pair_(build), binding_(build, 3, requests(build.primitive), 4) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        EvalState& state = binding_.begin(ray, context);
        const double c = binding_.evaluate(0, state);
        return state.error == EvalError::none && shade_mixed(pair_, c, ray, context);
    }

  private:
    static std::vector<ExpressionRequest> requests(const Primitive& primitive) {
        require_arguments(primitive, 4);
        return {{primitive.strings[2], -1}};
    }
    MixedPair pair_;
    FunctionBinding binding_;
};

class DataMixture final : public Modifier {
  public:
    explicit DataMixture(const ModifierBuild& build) : pair_(build), lookup_(build, 2, 1) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        const auto c = lookup_.evaluate(ray, context, DataLookup::Order::forward, true);
        return c && shade_mixed(pair_, (*c)[0], ray, context);
    }

  private:
    MixedPair pair_;
    DataLookup lookup_;
};

class PictureMixture final : public Modifier {
  public:
    explicit PictureMixture(const ModifierBuild& build) : pair_(build), lookup_(build, 2, 1) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        const auto c = lookup_.evaluate(ray, context);
        return c && shade_mixed(pair_, (*c)[0], ray, context);
    }

  private:
    MixedPair pair_;
    PictureLookup lookup_;
};

/// Text chooses one branch outright.
class TextMixture final : public Modifier {
  public:
    explicit TextMixture(const ModifierBuild& build)
        : pair_(build), layout_(make_text_layout(build, 2, 0)) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        const ModifierId chosen = inside_text(layout_, ray, context) ? pair_.fore : pair_.back;
        bool has_material = false;
        context.tracer.enter_mixture(
            context, [&] { has_material = context.tracer.shade_chain(ray, chosen, context); });
        if (!has_material) return false;
        pair_.require_void_modifier();
        return true;
    }

  private:
    MixedPair pair_;
    TextLayout layout_;
};

}  // namespace

std::unique_ptr<const Modifier> make_mixture(const ModifierBuild& build) {
    switch (build.primitive.type) {
        case PrimitiveType::mixfunc:
            return std::make_unique<FunctionMixture>(build);
        case PrimitiveType::mixdata:
            return std::make_unique<DataMixture>(build);
        case PrimitiveType::mixpict:
            return std::make_unique<PictureMixture>(build);
        default:
            return std::make_unique<TextMixture>(build);
    }
}

}  // namespace lightwalk
