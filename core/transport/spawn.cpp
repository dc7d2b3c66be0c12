// Rays that begin at the eye or at the hit of another ray: what they inherit, and whether they are
// worth tracing.
#include <algorithm>
#include <cmath>

#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

/// Weight left after a segment of length `t` in a medium, for judging whether a child is worth
/// tracing.
double medium_estimate(const Medium& medium, double t) {
    const double depth = static_cast<double>(min_component(medium.extinction)) * t;
    if (depth <= 0.1) return 1;
    return depth > 92 ? 0 : std::exp(-depth);
}

/// -lr and -lw: whether the ray is worth tracing; Russian roulette may raise its weight.
bool within_limits(Ray& ray, bool has_coef, const RenderOptions& options) {
    const int lr = options.reflection_limit;
    const double lw = options.weight_limit;
    if (lr > 0) return ray.weight >= lw && ray.level <= lr;
    if (!has_coef) return ray.weight >= lw && ray.level <= -lr;
    if (lr < 0 && ray.level > -lr) return false;
    if (ray.weight >= lw) return true;
    if (ray.random.next() > ray.weight / lw) return false;
    ray.coef *= static_cast<float>(lw / ray.weight);
    ray.weight = lw;
    return true;
}

}  // namespace

Ray LightTransport::primary(const Vec3& origin, const Vec3& direction, double limit,
                            RandomStream random) const {
    Ray ray;
    start_primary(ray, origin, direction, limit, random);
    return ray;
}

void LightTransport::start_primary(Ray& ray, const Vec3& origin, const Vec3& direction,
                                   double limit, RandomStream random) const {
    ray.origin = origin;
    const double squared = fused_dot(direction, direction);
    // Normalising twice would change the last bits of a direction that is unit already.
    ray.direction = std::abs(squared - 1) <= 1e-15 ? direction : normalize(direction);
    ray.limit = limit;
    ray.medium = {options_.extinction, options_.albedo, static_cast<float>(options_.eccentricity),
                  nullptr};
    ray.random = random;
}

bool LightTransport::spawn(Ray& child, RayKind kind, Ray& parent, const Rgb* coef) const {
    const double share = coef ? std::min(1.0, static_cast<double>(max_component(*coef))) : 1.0;
    child.coef = coef ? *coef : Rgb{1, 1, 1};
    child.parent = &parent;
    child.kind = kind;
    child.history = static_cast<std::uint16_t>(parent.history | kind);
    if (is_infinite(parent.hit.t)) return false;
    child.origin = parent.hit.position;
    child.level = parent.level;
    child.target = parent.target;
    child.aimed = parent.aimed;
    child.medium = parent.medium;
    child.random = parent.random.child();
    child.path_length = parent.path_length + parent.hit.t;
    child.shadow_length = parent.in(kShadow) ? parent.shadow_length + parent.hit.t : 0;
    if (kind & kSameSide) {
        ++child.level;
        child.target = kNoTarget;
        child.clip = parent.clip;
        child.limit = 0;
    } else {
        child.clip = parent.next_clip;
        child.limit = limit_beyond(parent.limit, parent.hit.t);
    }
    child.weight = parent.weight * share * medium_estimate(parent.medium, parent.hit.t);
    child.hit = Hit{};
    child.pattern = {1, 1, 1};
    static_cast<RayRadiance&>(child) = {};
    child.next_clip = child.clip;
    if (child.weight <= 0) return false;
    if (child.in(kShadow)) return true;
    return within_limits(child, coef != nullptr, options_);
}

ShadowStart LightTransport::start_shadow(Ray& parent) {
    if (is_infinite(parent.hit.t)) return {};
    return {parent.weight * medium_estimate(parent.medium, parent.hit.t),
            parent.path_length + parent.hit.t,
            parent.in(kShadow) ? parent.shadow_length + parent.hit.t : 0, parent.random.child()};
}

Rgb LightTransport::accumulate(Ray& parent, const Ray& child) {
    const Rgb contribution = child.value * child.coef;
    parent.value += contribution;
    return contribution;
}

void LightTransport::pass_through(Ray& ray, TraceContext& context) const {
    Ray child;
    (void)spawn(child, kTransferred, ray, nullptr);
    if (is_infinite(ray.hit.t)) return;
    child.direction = ray.direction;
    trace(child, context);
    ray.value = child.value;
    ray.mirrored = child.mirrored;
    ray.reflected_path_length = ray.hit.t + child.reflected_path_length;
    ray.unreflected_path_length = ray.hit.t + child.unreflected_path_length;
}

PerturbedNormal perturb_normal(const Ray& ray) {
    const Vec3 sum = ray.hit.normal + ray.hit.perturbation;
    const double size = length(sum);
    if (size == 0) return {ray.hit.normal, ray.hit.cos_out};
    PerturbedNormal result{sum / size, 0};
    result.cosine = -dot(ray.direction, result.normal);
    if ((result.cosine > 0) != (ray.hit.cos_out > 0)) {
        result.normal += ray.direction * (2 * result.cosine);
        result.cosine = -result.cosine;
    }
    return result;
}

void flip_surface(Ray& ray) {
    ray.hit.normal = -ray.hit.normal;
    ray.hit.perturbation = -ray.hit.perturbation;
    ray.hit.cos_out = -ray.hit.cos_out;
}

}  // namespace lightwalk
