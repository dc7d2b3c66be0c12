// Walking modifier chains.
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

/// Irradiance mode (-i) concerns what the eye sees directly or straight through something.
bool wants_irradiance(const Ray& ray, const RenderOptions& options) {
    return options.irradiance && (ray.history & ~(kPrimary | kTransferred)) == 0;
}

}  // namespace

bool LightTransport::shade_chain(Ray& ray, ModifierId first, TraceContext& context) const {
    const bool irradiance = wants_irradiance(ray, options_);
    for (ModifierId m = first; m != kVoid;) {
        const ModifierRecord& record = scene_.modifier(m);
        if (irradiance && m != scene_.lambertian() && record.type != PrimitiveType::antimatter &&
            (is_material(record.type) || is_mixture(record.type))) {
            if (scene_.is_transparent(m)) {
                pass_through(ray, context);
                return true;
            }
            if (!is_light(record.type) && is_material(record.type)) {
                ray.pattern = {1, 1, 1};
                return scene_.modifier(scene_.lambertian()).node->shade(ray, context);
            }
        }
        if (record.node && record.node->shade(ray, context)) return true;
        m = record.next;
    }
    return false;
}

void LightTransport::shade_or_pass(Ray& ray, ModifierId first, TraceContext& context) const {
    if (!shade_chain(ray, first, context)) pass_through(ray, context);
}

void LightTransport::apply_textures(Ray& ray, ModifierId material_next,
                                    TraceContext& context) const {
    for (ModifierId m = material_next; m != kVoid;) {
        const ModifierRecord& record = scene_.modifier(m);
        if (record.node && record.node->shade(ray, context)) {
            throw InputError(
                record.primitive->where,
                std::string(to_string(record.type)) + " \"" + record.name +
                    "\": conflicting material: it modifies a surface that has one already");
        }
        m = record.next;
    }
}

}  // namespace lightwalk
