#include "core/trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/ambient/ambient_calculation.h"
#include "core/light/light_scratch.h"
#include "core/light/light_sources.h"

namespace lightwalk {
namespace {

constexpr double kFar = 0.99 * kHuge;  ///< beyond: nothing was hit

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

void count(const Ray& ray, RayCounters& counters) {
    if (ray.kind & kShadow) return;  // counted by the direct calculation
    if (ray.kind & kPrimary)
        ++counters.primary;
    else if (ray.kind & kAmbient)
        ++counters.ambient;
    else if (ray.kind & (kReflected | kSpecular))
        ++counters.specular;
    else
        ++counters.transmitted;
}

bool is_finite(const Rgb& c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

}  // namespace

RayCounters& RayCounters::operator+=(const RayCounters& o) {
    primary += o.primary;
    shadow += o.shadow;
    specular += o.specular;
    transmitted += o.transmitted;
    ambient += o.ambient;
    return *this;
}

AmbientCounters& AmbientCounters::operator+=(const AmbientCounters& o) {
    interpolated += o.interpolated;
    computed += o.computed;
    incomplete += o.incomplete;
    waits += o.waits;
    duplicates += o.duplicates;
    return *this;
}

bool ClipSet::contains(ModifierId m) const {
    return std::binary_search(modifiers.begin(), modifiers.end(), m);
}

TraceContext::TraceContext(const Tracer& for_tracer, WarningSink& to_warnings)
    : tracer(for_tracer), warnings(to_warnings), light(std::make_unique<LightScratch>()) {}
TraceContext::~TraceContext() = default;

Tracer::Tracer(const Scene& scene, const RenderOptions& options, WarningSink& warnings)
    : scene_(scene),
      options_(options),
      lights_(std::make_unique<LightSources>(scene, options_, warnings)) {
    if (options_.reflection_limit <= 0 && options_.weight_limit <= 0) {
        throw InputError("-lw must be positive when -lr is zero or negative (Russian roulette)");
    }
    ambient_ = std::make_unique<AmbientCalculation>(*this);
    lights_->prepare(*this, warnings);
}
Tracer::~Tracer() = default;

Ray Tracer::primary(const Vec3& origin, const Vec3& direction, double limit,
                    RandomStream random) const {
    Ray ray;
    ray.origin = origin;
    const double squared = fused_dot(direction, direction);
    // Normalising twice would change the last bits of a direction that is unit already.
    ray.direction = std::abs(squared - 1) <= 1e-15 ? direction : normalize(direction);
    ray.limit = limit;
    ray.medium = {options_.extinction, options_.albedo, static_cast<float>(options_.eccentricity),
                  nullptr};
    ray.random = random;
    return ray;
}

bool Tracer::spawn(Ray& child, RayKind kind, Ray& parent, const Rgb* coef) const {
    const double share = coef ? std::min(1.0, static_cast<double>(max_component(*coef))) : 1.0;
    child.coef = coef ? *coef : Rgb{1, 1, 1};
    child.parent = &parent;
    child.kind = kind;
    child.history = static_cast<std::uint16_t>(parent.history | kind);
    if (parent.hit.t >= kFar) return false;
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
        child.limit = parent.limit > kEpsilon ? parent.limit - parent.hit.t : 0;
    }
    child.weight = parent.weight * share * medium_estimate(parent.medium, parent.hit.t);
    child.hit = Hit{};
    child.pattern = {1, 1, 1};
    child.value = child.mirrored = Rgb{};
    child.mirrored_distance = child.unmirrored_distance = kHuge;
    child.next_clip = child.clip;
    if (child.weight <= 0) return false;
    if (child.in(kShadow)) return true;
    return within_limits(child, coef != nullptr, options_);
}

Rgb Tracer::accumulate(Ray& parent, const Ray& child) {
    const Rgb contribution = child.value * child.coef;
    parent.value += contribution;
    return contribution;
}

void Tracer::trace(Ray& ray, TraceContext& context) const {
    if (ray.kind == kPrimary) {
        context.clip_sets.clear();
        context.scatter_lists.clear();
    }
    if (context.depth >= kMaxDepth) return;
    if (ray.aimed) {
        ++context.depth;
        count(ray, context.counters);
        if (lights_->intersect_target(ray, *this)) {
            ray.unmirrored_distance = ray.hit.t;
            if (!shade_chain(ray, ray.hit.modifier, context)) {
                throw InputError(scene_.surface(ray.hit.surface).where,
                                 "light source \"" + scene_.surface(ray.hit.surface).name +
                                     "\" has no material");
            }
            apply_medium(ray, context);
        }
        --context.depth;
        return;
    }
    const double limit = ray.limit > kEpsilon ? ray.limit : kHuge;
    shade_hit(ray, scene_.geometry().intersect({ray.origin, ray.direction, limit}), context);
}

void Tracer::shade_hit(Ray& ray, const Hit& hit, TraceContext& context) const {
    if (context.depth >= kMaxDepth) return;
    ++context.depth;
    count(ray, context.counters);
    ray.hit = hit;
    ray.next_clip = ray.clip;
    if (hit.exists()) {
        ray.unmirrored_distance = hit.t;
        if (ray.clip && ray.clip->contains(hit.modifier)) {
            pass_through(ray, context);
        } else {
            shade_or_pass(ray, hit.modifier, context);
        }
    } else {
        ray.hit.t = kHuge;
        ray.hit.position = ray.origin;
        ray.hit.normal = -ray.direction;
        ray.hit.rod = 1;
        // At the aft clipping plane there is nothing, not even the background.
        if (ray.limit <= kEpsilon) {
            if (const std::optional<SurfaceId> seen = lights_->background(ray)) {
                ray.hit.surface = *seen;
                ray.hit.modifier = scene_.surface(*seen).modifier;
                (void)shade_chain(ray, ray.hit.modifier, context);
            }
        }
    }
    apply_medium(ray, context);
    if (!is_finite(ray.value)) {
        context.warnings.warn("a ray's value is not finite; it counts as black");
        ray.value = ray.mirrored = Rgb{};
    }
    --context.depth;
}

Ray Tracer::irradiance(const Vec3& point, const Vec3& normal, RandomStream random,
                       TraceContext& context) const {
    constexpr double kStandOff = 1.1e-4, kDistance = 1e-5;  // [m]
    context.clip_sets.clear();
    context.scatter_lists.clear();
    const Vec3 facing = normalize(normal);
    Ray ray = primary(point + facing * kStandOff, -facing, 0, random);
    Hit hit;
    hit.t = kDistance;
    hit.position = ray.origin + ray.direction * kDistance;
    hit.normal = facing;
    hit.rod = 1;
    hit.surface = scene_.lambertian_surface();
    hit.modifier = scene_.lambertian();
    shade_hit(ray, hit, context);
    return ray;
}

void Tracer::pass_through(Ray& ray, TraceContext& context) const {
    Ray child;
    (void)spawn(child, kTransferred, ray, nullptr);
    if (ray.hit.t >= kFar) return;
    child.direction = ray.direction;
    trace(child, context);
    ray.value = child.value;
    ray.mirrored = child.mirrored;
    ray.mirrored_distance = ray.hit.t + child.mirrored_distance;
    ray.unmirrored_distance = ray.hit.t + child.unmirrored_distance;
}

Rgb Tracer::ambient(Ray& ray, const Rgb& coef, const Vec3& normal, TraceContext& context) const {
    return ambient_->add(ray, coef, normal, context);
}

void Tracer::use_ambient_cache(AmbientCache* cache) {
    ambient_->use_cache(cache);
}

void Tracer::add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context,
                        const Vec3* front) const {
    lights_->add_direct(ray, coefficient, context, front);
}

void Tracer::apply_medium(Ray& ray, TraceContext& context) const {
    const Medium& medium = ray.medium;
    if (max_component(medium.extinction) <= 1e-10f) return;
    const bool shadow = ray.in(kShadow);
    Rgb left;
    for (std::size_t i = 0; i < 3; ++i) {
        double depth = ray.hit.t * static_cast<double>(medium.extinction[i]);
        if (shadow) depth *= 1 - static_cast<double>(medium.albedo[i]);
        left[i] = depth <= kEpsilon ? 1.0f
                  : depth > 92      ? 0.0f
                                    : static_cast<float>(std::exp(-depth));
    }
    ray.value *= left;
    if (shadow || max_component(medium.albedo) <= static_cast<float>(kEpsilon)) return;
    ray.value += medium.albedo * options_.ambient_value * (Rgb{1, 1, 1} - left);
    lights_->add_in_scatter(ray, context);
}

PerturbedNormal perturb_normal(const Ray& ray) {
    const Vec3 sum = ray.hit.normal + ray.hit.perturbation;
    const double size = length(sum);
    if (size == 0) return {ray.hit.normal, ray.hit.rod};
    PerturbedNormal result{sum / size, 0};
    result.cosine = -dot(ray.direction, result.normal);
    if ((result.cosine > 0) != (ray.hit.rod > 0)) {
        result.normal += ray.direction * (2 * result.cosine);
        result.cosine = -result.cosine;
    }
    return result;
}

void flip_surface(Ray& ray) {
    ray.hit.normal = -ray.hit.normal;
    ray.hit.perturbation = -ray.hit.perturbation;
    ray.hit.rod = -ray.hit.rod;
}

}  // namespace lightwalk
