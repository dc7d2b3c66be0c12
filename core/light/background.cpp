// What rays see that leave the scene, and what aimed rays see of their own source.
#include "core/light/light_sources.h"

namespace lightwalk {
namespace {

bool contains(const LightSource& source, const Vec3& direction) {
    return 2 * kPi * (1 - dot(source.center, direction)) <= static_cast<double>(source.size);
}

}  // namespace

std::optional<SurfaceId> LightSources::background(const Ray& ray) const {
    if (ray.target != kNoTarget) {
        const LightSource& source = (*this)[ray.target];
        if (!source.is_distant() || source.is_virtual() || !contains(source, ray.direction))
            return std::nullopt;
        return source.object;
    }
    std::optional<SurfaceId> glow;
    bool illum = false;
    for (const std::int32_t i : distant_) {
        const LightSource& source = (*this)[i];
        if (!contains(source, ray.direction)) continue;
        if (source.material_type == PrimitiveType::glow || source.unusable) {
            if (!glow) glow = source.object;
        } else if (source.transparent_illum) {
            illum = true;
        } else {
            return source.object;
        }
    }
    // The illum's light reaches indirect rays through the direct calculation.
    if (illum && ray.in(kAmbient | kSpecular)) return std::nullopt;
    return glow;
}

bool LightSources::intersect_target(Ray& ray, const LightTransport& tracer) const {
    ray.hit = Hit{};
    ray.next_clip = ray.clip;
    if (ray.target == kNoTarget) return false;
    const LightSource& source = (*this)[ray.target];
    if (!source.is_distant() || source.is_virtual()) {
        ray.hit = tracer.scene().geometry().intersect_surface(source.object,
                                                              {ray.origin, ray.direction, kHuge});
        return ray.hit.exists();
    }
    if (!contains(source, ray.direction)) return false;
    ray.hit.position = ray.origin;
    ray.hit.normal = -ray.direction;
    ray.hit.surface = source.object;
    ray.hit.modifier = tracer.scene().surface(source.object).modifier();
    return true;
}

}  // namespace lightwalk
