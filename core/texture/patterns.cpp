// Patterns multiply the ray's pattern colour in single precision, without clamping.
#include <array>

#include "core/scene/modifier.h"
#include "core/texture/arguments.h"
#include "core/texture/lookup.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

class BrightnessFunction final : public Modifier {
  public:
    explicit BrightnessFunction(const ModifierBuild& build)
        : binding_(build, 1, requests(build.primitive), 2) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        EvalState& state = binding_.begin(ray, context);
        const double value = binding_.evaluate(0, state);
        if (state.error == EvalError::none) ray.pattern *= static_cast<float>(value);
        return false;
    }
    const FunctionBinding* brightness_function() const override { return &binding_; }

  private:
    static std::vector<ExpressionRequest> requests(const Primitive& primitive) {
        require_arguments(primitive, 2);
        return {{primitive.strings[0], -1}};
    }
    FunctionBinding binding_;
};

class ColorFunction final : public Modifier {
  public:
    explicit ColorFunction(const ModifierBuild& build)
        : binding_(build, 3, three_expressions(build.primitive), 4) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        EvalState& state = binding_.begin(ray, context);
        Rgb color;
        // Blue first, as in Radiance: the order is visible when an expression fails.
        for (std::size_t k = 3; k-- > 0;)
            color[k] = static_cast<float>(binding_.evaluate(k, state));
        if (state.error == EvalError::none) ray.pattern *= color;
        return false;
    }

  private:
    FunctionBinding binding_;
};

Rgb to_rgb(const std::array<double, 3>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

class DataPattern final : public Modifier {
  public:
    explicit DataPattern(const ModifierBuild& build)
        : color_(build.primitive.type == PrimitiveType::colordata),
          lookup_(build, 0, color_ ? 3 : 1) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        const auto order = color_ ? DataLookup::Order::forward : DataLookup::Order::backward;
        if (const auto v = lookup_.evaluate(ray, context, order, true)) {
            ray.pattern *= color_ ? to_rgb(*v) : Rgb::grey(static_cast<float>((*v)[0]));
        }
        return false;
    }

  private:
    bool color_;
    DataLookup lookup_;
};

class PicturePattern final : public Modifier {
  public:
    explicit PicturePattern(const ModifierBuild& build) : lookup_(build, 0, 3) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        if (const auto v = lookup_.evaluate(ray, context)) ray.pattern *= to_rgb(*v);
        return false;
    }

  private:
    PictureLookup lookup_;
};

}  // namespace

std::unique_ptr<const Modifier> make_function_pattern(const ModifierBuild& build) {
    if (build.primitive.type == PrimitiveType::brightfunc)
        return std::make_unique<BrightnessFunction>(build);
    return std::make_unique<ColorFunction>(build);
}

std::unique_ptr<const Modifier> make_data_pattern(const ModifierBuild& build) {
    return std::make_unique<DataPattern>(build);
}

std::unique_ptr<const Modifier> make_picture_pattern(const ModifierBuild& build) {
    return std::make_unique<PicturePattern>(build);
}

}  // namespace lightwalk
