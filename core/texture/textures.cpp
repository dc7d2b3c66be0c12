// Textures add a displacement to the surface normal. It is given in function space and carried to
// the world without its scale.
#include "core/scene/modifier.h"
#include "core/texture/arguments.h"
#include "core/texture/lookup.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

class FunctionTexture final : public Modifier {
  public:
    explicit FunctionTexture(const ModifierBuild& build)
        : binding_(build, 3, three_expressions(build.primitive), 4) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        EvalState& state = binding_.begin(ray, context);
        Vec3 displacement;
        for (std::size_t k = 0; k < 3; ++k) {
            displacement[k] = binding_.evaluate(k, state);
            if (state.error != EvalError::none) return false;
        }
        ray.hit.perturbation += binding_.to_world(displacement, ray, context);
        return false;
    }

  private:
    FunctionBinding binding_;
};

class DataTexture final : public Modifier {
  public:
    explicit DataTexture(const ModifierBuild& build)
        : lookup_((require_arguments(build.primitive, 8), build), 0, 3) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        if (const auto v = lookup_.evaluate(ray, context, DataLookup::Order::forward, false)) {
            ray.hit.perturbation +=
                lookup_.binding().to_world({(*v)[0], (*v)[1], (*v)[2]}, ray, context);
        }
        return false;
    }

  private:
    DataLookup lookup_;
};

}  // namespace

std::unique_ptr<const Modifier> make_function_texture(const ModifierBuild& build) {
    return std::make_unique<FunctionTexture>(build);
}

std::unique_ptr<const Modifier> make_data_texture(const ModifierBuild& build) {
    return std::make_unique<DataTexture>(build);
}

}  // namespace lightwalk
