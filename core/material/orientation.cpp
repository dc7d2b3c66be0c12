#include "core/material/orientation.h"

#include "core/material/argument_checks.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

FunctionBinding bind_functions(const ModifierBuild& build) {
    require_least_strings(build.primitive, 4);
    const std::vector<std::string>& s = build.primitive.strings;
    return FunctionBinding(build, 3, {{s[0], -1}, {s[1], -1}, {s[2], -1}}, 4);
}

}  // namespace

OrientedFrame orient(const Vec3& along, const Vec3& n) {
    const Vec3 across = cross(n, along);
    if (!(length_squared(across) > 0)) {
        return {frame_about(n), true};
    }
    const Vec3 v = normalize(across);
    return {{cross(v, n), v, n}, false};
}

Orientation::Orientation(const ModifierBuild& build) : binding_(bind_functions(build)) {}

OrientedFrame Orientation::at(const Ray& ray, const Vec3& n, TraceContext& context) const {
    EvalState& state = binding_.begin(ray, context);
    const double x = binding_.evaluate(0, state);
    const double y = binding_.evaluate(1, state);
    const double z = binding_.evaluate(2, state);
    if (state.error != EvalError::none) {
        context.warnings.warn("the orientation of a brushed material cannot be computed here");
        return orient({}, n);
    }
    return orient(binding_.to_world({x, y, z}, ray, context), n);
}

}  // namespace lightwalk
