#pragma once
// The surface that a material shades: turned to the viewer, its normal perturbed by textures.
#include "core/scene/scene.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

/// Cosines that are divided by are kept at least this large.
inline constexpr double kMinCosine = 1e-3;

/// Apply textures and patterns to a sheet that looks alike from both sides: in the surface's own
/// orientation, then a back face is turned over. Returns false when back faces are invisible (-bv-)
/// and the ray has passed through one: nothing is left to shade.
[[nodiscard]] inline bool turn_to_viewer(Ray& ray, ModifierId textures, TraceContext& context) {
    if (ray.hit.cos_out < 0 && !context.tracer.options().back_faces_visible) {
        context.tracer.pass_through(ray, context);
        return false;
    }
    context.tracer.apply_textures(ray, textures, context);
    if (ray.hit.cos_out < 0) flip_surface(ray);
    return true;
}

/// The shading normal: exactly the geometric one where no texture has perturbed it.
[[nodiscard]] inline PerturbedNormal textured_normal(const Ray& ray, bool perturbed) {
    return perturbed ? perturb_normal(ray) : PerturbedNormal{ray.hit.normal, ray.hit.cos_out};
}

/// Whether the ray hit a polygon or a ring.
[[nodiscard]] inline bool is_flat_hit(const Ray& ray, const TraceContext& context) {
    return ray.hit.exists() && context.tracer.scene().surface(ray.hit.surface).is_flat();
}

/// Whether the surface that was hit has a modifier named "Phong": as in Radiance, textures of such
/// surfaces do not bend what they transmit.
[[nodiscard]] inline bool is_phong_hit(const Ray& ray, const TraceContext& context) {
    return ray.hit.modifier != kVoid &&
           context.tracer.scene().modifier(ray.hit.modifier).named_phong;
}

/// Mirror direction of a ray.
/// @param direction  of the ray, -wo
/// @param cosine     wo · n
[[nodiscard]] inline Vec3 mirror_direction(const Vec3& direction, const Vec3& n, double cosine) {
    return normalize(fused_advance(direction, n, 2 * cosine));
}

/// Where a ray goes that a sheet transmits: bent by the perturbation of the normal, but straight on
/// where it would leave on the wrong side of the surface.
/// @param direction  of the ray, -wo
/// @param n          geometric normal towards wo
[[nodiscard]] inline Vec3 bent_through(const Vec3& direction, const Vec3& perturbation,
                                       const Vec3& n) {
    const Vec3 bent = direction - perturbation;
    return dot(bent, n) < -kEpsilon ? normalize(bent) : direction;
}

/// Note on a ray what it sees by mirror-like reflection and how far away that is, for the distance
/// that the ray reports.
/// @param contribution  of the reflected ray to the value of `ray`
/// @param unfold        measure the path on to what is seen in the mirror; else it ends there
inline void note_mirrored(Ray& ray, const Ray& child, const Rgb& contribution, bool unfold) {
    ray.mirrored = contribution;
    ray.reflected_path_length = ray.hit.t;
    if (unfold) ray.reflected_path_length += child.effective_distance();
}

}  // namespace lightwalk
