// Rays traced: nearest hit, shading, sources, indirect light and medium brought together.
#include <cmath>
#include <string>

#include "core/ambient/ambient_calculation.h"
#include "core/batch/shading_batch.h"
#include "core/light/light_scratch.h"
#include "core/light/light_sources.h"
#include "core/transport/tracer.h"
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
        if (context_.depth++ == 0 && !context_.batch) context_.start_path();
    }
    ~OpenRay() { --context_.depth; }
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

class OpenBatch {
  public:
    explicit OpenBatch(TraceContext& context) : context_(context) {
        if (context.open_batches == context.batches.size())
            context.batches.push_back(std::make_unique<ShadingBatch>(
                context.make_fibers(context.batches.empty() ? kPixelRays : kAmbientRays)));
        ++context.open_batches;
    }
    ~OpenBatch() { --context_.open_batches; }
    OpenBatch(const OpenBatch&) = delete;
    OpenBatch& operator=(const OpenBatch&) = delete;
    ShadingBatch* operator->() const { return context_.batches[context_.open_batches - 1].get(); }

  private:
    TraceContext& context_;
};

}  // namespace

TraceContext::TraceContext(const Tracer& for_tracer, WarningSink& to_warnings)
    : tracer(for_tracer), warnings(to_warnings), light(std::make_unique<LightScratch>()) {}
TraceContext::~TraceContext() = default;

void TraceContext::start_path() {
    clip_sets.clear();
    scatter_lists.clear();
}

Tracer::Tracer(const Scene& scene, const RenderOptions& options, WarningSink& warnings,
               const TaskRunner& task_runner)
    : scene_(scene),
      options_(options),
      lights_(std::make_unique<LightSources>(scene, options_, warnings)) {
    if (options_.reflection_limit <= 0 && options_.weight_limit <= 0) {
        throw InputError("-lw must be positive when -lr is zero or negative (Russian roulette)");
    }
    ambient_ = std::make_unique<AmbientCalculation>(*this);
    VirtualSourceBuilder(*lights_, *this, warnings).build();
    lights_->finalize(*this, warnings, task_runner);
}
Tracer::~Tracer() = default;

void Tracer::trace(Ray& ray, TraceContext& context) const {
    if (context.depth >= kMaxDepth) return;
    if (ray.aimed) {
        const OpenRay open(context);
        count(ray, context.counters);
        if (lights_->intersect_target(ray, *this)) {
            ray.unreflected_path_length = ray.hit.t;
            if (!shade_chain(ray, ray.hit.modifier, context)) {
                const Surface surface = scene_.surface(ray.hit.surface);
                throw InputError(surface.where(), "light source \"" + std::string(surface.name()) +
                                                      "\" has no material");
            }
            apply_medium(ray, context);
        }
        return;
    }
    const double limit = ray.limit > kEpsilon ? ray.limit : kHuge;
    shade_hit(ray, scene_.geometry().intersect({ray.origin, ray.direction, limit}), context);
}

void Tracer::go_deeper(TraceContext& context, FunctionRef<void()> deeper) {
    if (context.batch && !context.batch->has_room())
        context.batch->outside(deeper, context);
    else
        deeper();
}

void Tracer::shade_hits(std::span<Ray> rays, std::span<const Hit> hits,
                        TraceContext& context) const {
    const auto shade = [&](std::size_t i) { shade_hit(rays[i], hits[i], context); };
    // To wait and go on costs a ray as much as some candidates gain by going side by side.
    const bool few = context.light->candidates < kWorthWaiting * context.light->points;
    const bool alone = few || !context.make_fibers || rays.size() == 1 ||
                       context.open_batches == kMostBatches || context.observer ||
                       context.missing || lights_->sampled().empty();
    if (alone) {
        for (std::size_t i = 0; i < rays.size(); ++i) shade(i);
        return;
    }
    const OpenBatch batch(context);
    const auto calculate = [&](std::span<const DirectRequest> requests) {
        lights_->add_direct(requests, context);
    };
    batch->run(rays.size(), shade, calculate, context);
}

void Tracer::shade_hit(Ray& ray, const Hit& hit, TraceContext& context) const {
    if (context.depth >= kMaxDepth) return;
    if (context.batch && !context.batch->has_room()) {
        context.batch->outside([&] { shade_hit(ray, hit, context); }, context);
        return;
    }
    const OpenRay open(context);
    count(ray, context.counters);
    ray.hit = hit;
    ray.next_clip = ray.clip;
    if (hit.exists()) {
        ray.unreflected_path_length = hit.t;
        if (ray.clip && ray.clip->contains(hit.modifier)) {
            pass_through(ray, context);
        } else {
            shade_or_pass(ray, hit.modifier, context);
        }
    } else {
        ray.hit.t = kHuge;
        ray.hit.position = ray.origin;
        ray.hit.normal = -ray.direction;
        ray.hit.cos_out = 1;
        // At the aft clipping plane there is nothing, not even the background.
        if (ray.limit <= kEpsilon) {
            if (const std::optional<SurfaceId> seen = lights_->background(ray)) {
                ray.hit.surface = *seen;
                ray.hit.modifier = scene_.surface(*seen).modifier();
                (void)shade_chain(ray, ray.hit.modifier, context);
            }
        }
    }
    apply_medium(ray, context);
    if (!is_finite(ray.value)) {
        context.warnings.warn("a ray's value is not finite; it counts as black");
        ray.value = ray.mirrored = Rgb{};
    }
    if (context.observer) context.observer->finished(ray, hit);
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
    hit.surface = scene_.lambertian_surface();
    hit.modifier = scene_.lambertian();
    shade_hit(ray, hit, context);
    return ray;
}

Rgb Tracer::ambient(Ray& ray, const Rgb& coef, const Vec3& normal, TraceContext& context) const {
    return ambient_->add(ray, coef, normal, context);
}

void Tracer::use_ambient_cache(AmbientCache* cache) {
    ambient_->use_cache(cache);
}

void Tracer::add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context,
                        const Vec3* front) const {
    if (context.missing != nullptr || lights_->sampled().empty()) return;
    const DirectRequest request{&ray, coefficient, front};
    if (context.batch && context.batch->level() == context.ambient_level)
        context.batch->wait(request, context);
    else
        lights_->add_direct({&request, 1}, context);
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

}  // namespace lightwalk
