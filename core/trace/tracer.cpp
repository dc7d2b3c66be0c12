#include "core/trace/tracer.h"

#include <cmath>
#include <optional>
#include <string>

#include "core/ambient/ambient_calculation.h"
#include "core/batch/shading_batch.h"
#include "core/light/light_scratch.h"
#include "core/light/light_sources.h"
#include "core/transport/contribution.h"
#include "core/transport/light_groups.h"
#include "core/virtual_source/virtual_sources.h"

namespace lightwalk {
namespace {

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

/// While it lives a ray is being evaluated; the outermost one starts a path.
class OpenRay {
  public:
    explicit OpenRay(TraceContext& context) : context_(context) {
        if (context_.path.nesting.rays++ == 0 && !context_.batches.current) context_.path.start();
    }
    ~OpenRay() { --context_.path.nesting.rays; }
    OpenRay(const OpenRay&) = delete;
    OpenRay& operator=(const OpenRay&) = delete;

  private:
    TraceContext& context_;
};

/// Batches of ambient rays are within those of the rays that ask. Deeper than this there are few.
constexpr std::size_t kMostBatches = 3;
/// Rays of a batch: those of pixels lie near each other, ambient ones do not. Each costs two of the
/// mappings of memory of which a process has some 65,000.
constexpr std::size_t kPixelRays = 64, kAmbientRays = 16;
/// Candidates a point from which batches are faster (measured on seven models).
constexpr std::size_t kWorthWaiting = 2;

/// One more batch, inside those that are open.
class OpenBatch {
  public:
    explicit OpenBatch(BatchState& batches) : batches_(batches) {
        if (batches.open == batches.all.size())
            batches.all.push_back(make_opaque<ShadingBatch>(
                batches.make_fibers(batches.all.empty() ? kPixelRays : kAmbientRays)));
        ++batches.open;
    }
    ~OpenBatch() { --batches_.open; }
    OpenBatch(const OpenBatch&) = delete;
    OpenBatch& operator=(const OpenBatch&) = delete;
    ShadingBatch* operator->() const { return batches_.all[batches_.open - 1].get(); }

  private:
    BatchState& batches_;
};

/// While it lives a branch of a mixture is being evaluated.
class OpenMixture {
  public:
    explicit OpenMixture(PathState& path) : path_(path) { ++path_.nesting.mixtures; }
    ~OpenMixture() { --path_.nesting.mixtures; }
    OpenMixture(const OpenMixture&) = delete;
    OpenMixture& operator=(const OpenMixture&) = delete;

  private:
    PathState& path_;
};

/// Whether points had so few light candidates of late that batches are not worth their while: to
/// wait and go on costs a ray as much as some candidates gain by being calculated together.
bool has_few_candidates(const TraceContext& context) {
    const LightScratch* light = context.light.get();
    return light && light->candidates < kWorthWaiting * light->points;
}

}  // namespace

Tracer::Tracer(const Scene& scene, const RenderOptions& options, WarningSink& warnings,
               const TaskRunner& task_runner, const LightMeasures* known)
    : LightTransport(scene, options),
      lights_(std::make_unique<LightSources>(scene, options, warnings)) {
    if (options.reflection_limit <= 0 && options.weight_limit <= 0) {
        throw InputError("-lw must be positive when -lr is zero or negative (Russian roulette)");
    }
    ambient_ = std::make_unique<AmbientCalculation>(*this);
    VirtualSourceBuilder(*lights_, *this, warnings).build();
    lights_->finalize(*this, warnings, task_runner, known);
}
Tracer::~Tracer() = default;

void Tracer::trace(Ray& ray, TraceContext& context) const {
    if (context.path.nesting.rays >= kMaxDepth) return;
    if (ray.aimed)
        shade_target(ray, context);
    else if (context.groups && ray.kind == kReflected && !ray.parent->parent)
        trace_apart(ray, *context.groups, context);
    else
        shade_hit(ray, scene().geometry().intersect(ray.segment()), context);
}

/// What a primary ray's mirror shows is a part of it that is known by itself (Ray::mirrored).
void Tracer::trace_apart(Ray& ray, GroupSums& groups, TraceContext& context) const {
    GroupSums::Part told(&groups);
    shade_hit(ray, scene().geometry().intersect(ray.segment()), context);
    groups.note_reflected();
    told.keep();
}

/// Evaluate a ray for which nothing but its target exists.
void Tracer::shade_target(Ray& ray, TraceContext& context) const {
    const OpenRay open(context);
    count(ray, context.counters.rays);
    if (!lights_->intersect_target(ray, *this)) return;
    ray.unreflected_path_length = ray.hit.t;
    if (!shade_chain(ray, ray.hit.modifier, context)) {
        const Surface surface = scene().surface(ray.hit.surface);
        throw InputError(surface.where(),
                         "light source \"" + std::string(surface.name()) + "\" has no material");
    }
    apply_medium(ray, context);
}

void Tracer::enter_mixture(TraceContext& context, FunctionRef<void()> branch) const {
    const OpenMixture open(context.path);
    ShadingBatch* batch = context.batches.current;
    if (batch && !batch->has_room())
        batch->outside(branch, context);
    else
        branch();
}

void Tracer::shade_hits(std::span<Ray> rays, std::span<const Hit> hits,
                        TraceContext& context) const {
    shade_all(
        rays.size(), [&](std::size_t i) { shade_hit(rays[i], hits[i], context); }, context);
}

void Tracer::shade_hits(std::span<Ray> rays, std::span<const Hit> hits, TraceContext& context,
                        FunctionRef<void(std::size_t)> shaded) const {
    const auto shade = [&](std::size_t i) {
        const GroupSums::OwnAccount own(*context.groups);
        shade_hit(rays[i], hits[i], context);
        shaded(i);
    };
    shade_all(rays.size(), shade, context);
}

void Tracer::shade_all(std::size_t count, FunctionRef<void(std::size_t)> shade,
                       TraceContext& context) const {
    const BatchState& batches = context.batches;
    const bool alone = has_few_candidates(context) || !batches.make_fibers || count == 1 ||
                       batches.open == kMostBatches || context.observer ||
                       !options().ablation.batches || context.ambient.missing ||
                       lights_->sampled().empty();
    if (alone) {
        for (std::size_t i = 0; i < count; ++i) shade(i);
        return;
    }
    const OpenBatch batch(context.batches);
    const auto calculate = [&](std::span<const DirectRequest> requests) {
        lights_->add_direct(requests, context);
    };
    const bool in_order = ambient_->depends_on_order(context);
    batch->run(count, shade, calculate, context,
               in_order ? BatchWaits::at_their_end : BatchWaits::anywhere);
}

void Tracer::shade_hit(Ray& ray, const Hit& hit, TraceContext& context) const {
    if (context.path.nesting.rays >= kMaxDepth) return;
    if (ShadingBatch* batch = context.batches.current; batch && !batch->has_room()) {
        batch->outside([&] { shade_hit(ray, hit, context); }, context);
        return;
    }
    const OpenRay open(context);
    count(ray, context.counters.rays);
    ray.hit = hit;
    ray.next_clip = ray.clip;
    if (!hit.exists()) {
        shade_background(ray, context);
    } else {
        ray.unreflected_path_length = hit.t;
        if (ray.clip && ray.clip->contains(hit.modifier))
            pass_through(ray, context);
        else
            shade_or_pass(ray, hit.modifier, context);
    }
    apply_medium(ray, context);
    if (!is_finite(ray.value)) {
        context.warnings.warn("a ray's value is not finite; it counts as black");
        ray.value = ray.mirrored = Rgb{};
    }
    if (context.observer) context.observer->finished(ray, hit);
}

void Tracer::shade_background(Ray& ray, TraceContext& context) const {
    ray.hit.t = kHuge;
    ray.hit.position = ray.origin;
    ray.hit.normal = -ray.direction;
    ray.hit.cos_out = 1;
    // At the aft clipping plane there is nothing, not even the background.
    if (is_limited(ray.limit)) return;
    if (const std::optional<SurfaceId> seen = lights_->background(ray)) {
        ray.hit.surface = *seen;
        ray.hit.modifier = scene().surface(*seen).modifier();
        (void)shade_chain(ray, ray.hit.modifier, context);
    }
}

Ray Tracer::irradiance(const Vec3& point, const Vec3& normal, RandomStream random,
                       TraceContext& context) const {
    constexpr double kStandOff = 1.1e-4, kDistance = 1e-5;  // [m]
    const Vec3 facing = normalize(normal);
    Ray ray = primary(point + facing * kStandOff, -facing, 0, random);
    Hit hit;
    hit.t = kDistance;
    hit.position = ray.origin + ray.direction * kDistance;
    hit.normal = facing;
    hit.cos_out = 1;
    hit.surface = scene().lambertian_surface();
    hit.modifier = scene().lambertian();
    shade_hit(ray, hit, context);
    return ray;
}

Rgb Tracer::ambient(Ray& ray, const Rgb& coef, const Vec3& normal, TraceContext& context) const {
    return ambient_->add(ray, coef, normal, context);
}

void Tracer::use_ambient_cache(AmbientCache* cache) {
    ambient_->use_cache(cache);
}

void Tracer::use_coefficients(const CoefficientCache* cache) {
    coefficients_ = cache;
    ambient_->use_coefficients(cache);
}

void Tracer::add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context,
                        const Vec3* front) const {
    if (context.ambient.missing != nullptr || lights_->sampled().empty()) return;
    const DirectRequest request{&ray, coefficient, front,
                                context.groups ? context.groups->account() : nullptr};
    ShadingBatch* batch = context.batches.current;
    if (batch && batch->may_wait(context))
        batch->wait(request, context);
    else
        lights_->add_direct({&request, 1}, context);
}

/// What the medium takes from and adds to the radiance along the ray's segment.
void Tracer::apply_medium(Ray& ray, TraceContext& context) const {
    const Medium& medium = ray.medium;
    if (max_component(medium.extinction) <= 1e-10f) return;
    const bool shadow = ray.in(kShadow);
    const Rgb left = transmittance(medium, ray.hit.t, shadow);
    ray.value *= left;
    if (shadow || max_component(medium.albedo) <= static_cast<float>(kEpsilon)) return;
    ray.value += medium.albedo * options().ambient_value * (Rgb{1, 1, 1} - left);
    if (context.contributions) {
        const Rgb coefficient = path_coefficient(ray, context.contributions->root()) *
                                medium.albedo * (Rgb{1, 1, 1} - left);
        tell_constant(ray, coefficient, options().ambient_value, *context.contributions);
    }
    lights_->add_in_scatter(ray, context);
}

}  // namespace lightwalk
