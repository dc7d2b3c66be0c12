#pragma once
// The surface as a material meets it: turned to the viewer, its normal moved by textures.
#include "core/scene/scene.h"
#include "core/transport/tracer.h"

namespace lightwalk {

/// Cosines that divide are kept this far from zero.
inline constexpr double kMinCosine = 1e-3;

/// Textures and patterns for a sheet that looks alike from both sides: they run in the surface's
/// own orientation, then a back face is turned over. False: back faces are invisible (-bv-) and the
/// ray has gone on.
[[nodiscard]] inline bool turn_to_viewer(Ray& ray, ModifierId textures, TraceContext& context) {
    if (ray.hit.cos_out < 0 && !context.tracer.options().back_faces_visible) {
        context.tracer.pass_through(ray, context);
        return false;
    }
    context.tracer.apply_textures(ray, textures, context);
    if (ray.hit.cos_out < 0) flip_surface(ray);
    return true;
}

/// The normal that textures left; exactly the geometric one where none acted.
[[nodiscard]] inline PerturbedNormal textured_normal(const Ray& ray, bool perturbed) {
    return perturbed ? perturb_normal(ray) : PerturbedNormal{ray.hit.normal, ray.hit.cos_out};
}

/// Whether the hit object is a polygon or a ring.
[[nodiscard]] inline bool is_flat_hit(const Ray& ray, const TraceContext& context) {
    return ray.hit.exists() && context.tracer.scene().surface(ray.hit.surface).is_flat();
}

/// Surfaces whose modifier is named "Phong" do not bend what they transmit.
[[nodiscard]] inline bool is_phong_hit(const Ray& ray, const TraceContext& context) {
    return ray.hit.modifier != kVoid &&
           context.tracer.scene().modifier(ray.hit.modifier).named_phong;
}

/// Direction of a mirror reflection; `cosine` is -v . n.
[[nodiscard]] inline Vec3 mirror_direction(const Vec3& v, const Vec3& n, double cosine) {
    return normalize(fused_advance(v, n, 2 * cosine));
}

/// Where a sheet sends transmitted light: straight on along v, or bent by the texture unless that
/// leaves the surface on the wrong side.
[[nodiscard]] inline Vec3 bent_through(const Vec3& v, const Vec3& perturbation, const Vec3& n) {
    const Vec3 bent = v - perturbation;
    return dot(bent, n) < -kEpsilon ? normalize(bent) : v;
}

/// Record a mirror-like reflection for the distance that the ray reports; `unfold`: measure on to
/// what is seen.
inline void note_mirrored(Ray& ray, const Ray& child, const Rgb& contribution, bool unfold) {
    ray.mirrored = contribution;
    ray.reflected_path_length = ray.hit.t;
    if (unfold) ray.reflected_path_length += child.effective_distance();
}

}  // namespace lightwalk
