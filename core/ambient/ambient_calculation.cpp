#include "core/ambient/ambient_calculation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/ambient/ambient_request.h"
#include "core/ambient/coefficient_calculation.h"
#include "core/ambient/derivatives.h"
#include "core/math/direction_code.h"
#include "core/transport/contribution.h"
#include "core/transport/light_groups.h"

namespace lightwalk {
namespace {

constexpr double kReflectance = kAssumedReflectance;
constexpr int kFewestDivisions = 7;  ///< for gradients
/// Of the samples that Radiance gives a value, by level: a value of a deeper level is one of the
/// hundreds of terms of the mean that a hemisphere takes, in which their errors cancel.
constexpr double kDeeperShare = 0.25;
constexpr double kFewestDeeper = 100;  ///< samples to which they are reduced: fewer spoil gradients
constexpr double kAligned = 0.9999;    ///< cosine of normals that count as one
constexpr double kLeastFactor =
    0.05;  ///< a correction for a tilted normal that is smaller is left out

std::array<float, 2> floats(const std::array<double, 2>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1])};
}

/// A claim, for as long as this lives.
class Claimed {
  public:
    Claimed(AmbientCache& cache, const AmbientQuery& query)
        : cache_(cache), claim_(cache.claim(query)) {}
    ~Claimed() { cache_.release(claim_); }
    Claimed(const Claimed&) = delete;
    Claimed& operator=(const Claimed&) = delete;
    [[nodiscard]] bool waited() const { return claim_.waited; }

  private:
    AmbientCache& cache_;
    AmbientClaim claim_;
};

/// The rays of one value's hemisphere.
class AmbientRays final : public HemisphereRays {
  public:
    /// @param coef   what the rays are weighed by, for their limits
    /// @param share  of each in the sum, beside that
    AmbientRays(const LightTransport& tracer, Ray& parent, RayKind kind, const Rgb& coef,
                float share, TraceContext& context)
        : tracer_(tracer),
          parent_(parent),
          kind_(kind),
          coef_(coef),
          share_(share),
          context_(context) {
        rays_.reserve(kTogether);
    }

    bool start(const Vec3& direction) override {
        Ray& child = rays_.emplace_back();
        if (!tracer_.spawn(child, kind_, parent_, &coef_)) {
            rays_.pop_back();
            return false;
        }
        child.coef *= share_;
        child.direction = direction;
        return true;
    }

    std::span<const HemisphereAnswer> trace() override {
        // One by one: they diverge too much for packets (measured in an interior: a tenth slower).
        const Geometry& geometry = tracer_.scene().geometry();
        hits_.clear();
        for (const Ray& ray : rays_) hits_.push_back(geometry.intersect(ray.segment()));
        if (tells_groups())
            shade_by_groups(*context_.groups);
        else
            tracer_.shade_hits(rays_, hits_, context_);
        answers_.clear();
        for (const Ray& ray : rays_)
            answers_.push_back({ray.value * ray.coef, ray.effective_distance()});
        rays_.clear();
        return answers_;
    }

    void taken(std::size_t answer, std::size_t cell, float kept, float share) override {
        const std::size_t groups = context_.groups->size();
        if (cells_.size() < (cell + 1) * groups) cells_.resize((cell + 1) * groups);
        for (std::size_t g = 0; g < groups; ++g) {
            Rgb& value = cells_[cell * groups + g];
            value = value * kept + told_[answer * groups + g] * share;
        }
    }

    /// What each light group adds to the sum of the cells' values; empty: nobody asks.
    [[nodiscard]] std::vector<Rgb> groups() const {
        if (!tells_groups()) return {};
        std::vector<Rgb> sums(context_.groups->size());
        for (std::size_t i = 0; i < cells_.size(); ++i) sums[i % sums.size()] += cells_[i];
        return sums;
    }

    [[nodiscard]] bool tells_groups() const { return context_.groups && !context_.ambient.missing; }

  private:
    /// How a ray's answer is made of what the groups bring is told ray by ray.
    void shade_by_groups(GroupSums& sums) {
        const GroupSums::Part apart(&sums, &parent_);
        told_.resize(rays_.size() * sums.size());
        tracer_.shade_hits(rays_, hits_, context_, [&](std::size_t i) {
            std::ranges::copy(sums.sums(),
                              told_.begin() + static_cast<std::ptrdiff_t>(i * sums.size()));
        });
    }

    const LightTransport& tracer_;
    Ray& parent_;
    RayKind kind_;
    Rgb coef_;
    float share_;
    TraceContext& context_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<HemisphereAnswer> answers_;
    std::vector<Rgb> told_;   ///< by answer, then light group
    std::vector<Rgb> cells_;  ///< by cell, then light group
};

/// Of a hemisphere's light where the normal is turned towards `n`, by its gradient.
float tilt_factor(const Hemisphere& h, const Vec3& n) {
    if (std::abs(dot(n, h.normal)) >= kAligned || !h.complete() || h.divisions < kFewestDivisions)
        return 1;
    const std::array<double, 2> rotation = rotation_gradient(h);
    const double factor = 1 + dot(cross(h.normal, n), h.u * rotation[0] + h.v * rotation[1]);
    return factor >= kLeastFactor ? static_cast<float>(factor) : 1;
}

}  // namespace

AmbientCalculation::~AmbientCalculation() = default;

AmbientCalculation::AmbientCalculation(const LightTransport& tracer) : tracer_(tracer) {
    const AmbientSelection& selection = tracer.options().ambient_surfaces;
    if (selection.kind == AmbientSelection::Kind::all) return;
    const Scene& scene = tracer.scene();
    listed_.resize(scene.modifier_count());
    for (std::size_t i = 0; i < listed_.size(); ++i) {
        const std::string& name = scene.modifier(ModifierId{static_cast<std::int32_t>(i)}).name;
        listed_[i] = std::find(selection.modifiers.begin(), selection.modifiers.end(), name) !=
                     selection.modifiers.end();
    }
}

void AmbientCalculation::use_coefficients(const CoefficientCache* cache) {
    coefficients_ = cache ? std::make_unique<CoefficientCalculation>(tracer_, *cache) : nullptr;
}

bool AmbientCalculation::takes_part(const Ray& ray) const {
    if (listed_.empty() || ray.hit.surface == tracer_.scene().lambertian_surface()) return true;
    const bool include = tracer_.options().ambient_surfaces.kind == AmbientSelection::Kind::include;
    const bool listed =
        ray.hit.modifier != kVoid && listed_[static_cast<std::size_t>(index(ray.hit.modifier))];
    return listed == include;
}

/// -av, or what -aw makes of it and of the values that are known: their logarithmic mean.
Rgb AmbientCalculation::constant(const Rgb& coef) const {
    const RenderOptions& options = tracer_.options();
    if (options.ambient_weight <= 0 || !cache_) return coef * options.ambient_value;
    const AmbientLogMean stored = cache_->log_mean();
    if (stored.count == 0) return coef * options.ambient_value;
    const auto b = static_cast<double>(brightness(options.ambient_value));
    const double k = static_cast<double>(stored.count), w = options.ambient_weight,
                 h = std::log(1 - kReflectance);
    if (b > kEpsilon) {
        const double mean = std::exp((w * std::log(b) + stored.sum + k * h) / (w + k));
        return coef * options.ambient_value * static_cast<float>(mean / b);
    }
    return coef * static_cast<float>(std::exp(stored.sum / k + h));
}

Rgb AmbientCalculation::told_constant(const Ray& ray, const Rgb& coef,
                                      TraceContext& context) const {
    const Rgb value = constant(coef);
    if (context.contributions)
        tell_constant(ray, path_throughput(ray, context.contributions->root()) * coef,
                      constant({1, 1, 1}), *context.contributions);
    return value;
}

/// Cached values are sums of the light of many emitters, or of groups of them.
bool AmbientCalculation::uses_cache(const TraceContext& context) const {
    return cache_ && tracer_.options().ambient_accuracy > kEpsilon && !context.asks_coefficients();
}

Rgb AmbientCalculation::add(Ray& ray, const Rgb& coef, const Vec3& normal,
                            TraceContext& context) const {
    const RenderOptions& options = tracer_.options();
    if (options.ambient_divisions <= 0 || context.path.ambient_level >= options.ambient_bounces ||
        !takes_part(ray)) {
        return told_constant(ray, coef, context);
    }
    const bool far_side = dot(normal, ray.hit.normal) < 0;
    const Request request{ray,
                          coef,
                          {ray.hit.position, far_side ? -ray.hit.normal : ray.hit.normal, normal,
                           context.path.ambient_level, ray.weight},
                          far_side,
                          context};
    if (coefficients_ && context.contributions) return with_coefficients(request);
    return uses_cache(context) ? with_cache(request) : without_cache(request);
}

/// A ray's own surroundings are not interpolated: it wants to know each bin by itself.
Rgb AmbientCalculation::with_coefficients(const Request& request) const {
    if (request.query.level == 0) return without_cache(request);
    if (request.query.level == CoefficientCache::kLevel) {
        if (const std::optional<Rgb> known = coefficients_->known(request)) return *known;
    }
    return by_one_ray(request);
}

bool AmbientCalculation::depends_on_order(const TraceContext& context) const {
    const RenderOptions& options = tracer_.options();
    return uses_cache(context) && options.ambient_divisions > 0 &&
           context.path.ambient_level < options.ambient_bounces &&
           (context.ambient.new_records || cache_->takes_values());
}

/// Of a hemisphere, per axis.
int AmbientCalculation::divisions(double weight, bool cached) const {
    const double samples = tracer_.options().ambient_divisions * weight;
    const double divisions = std::min(std::floor(std::sqrt(samples) + 0.5), 1000.0);
    return std::max(static_cast<int>(divisions), cached ? kFewestDivisions : 1);
}

Hemisphere AmbientCalculation::sample(const Request& request, const Rgb& coef, double weight,
                                      bool cached) const {
    const RenderOptions& options = tracer_.options();
    Ray& ray = request.ray;
    HemisphereSampling sampling;
    sampling.divisions = divisions(weight, cached);
    if (request.context.ambient.missing == nullptr && !request.context.asks_coefficients()) {
        sampling.extra =
            static_cast<int>(std::min(options.ambient_super_samples * weight + 0.5, 1e6));
    }
    const float share = 1.0f / static_cast<float>(sampling.divisions * sampling.divisions);
    sampling.share = static_cast<double>(brightness(coef) * share);
    sampling.farthest = 10 * tracer_.scene().cube().size + 1000;
    const RayKind kind = request.far_side ? kAmbientThrough : kAmbientSame;
    // Cached values weigh their rays by the assumed reflectance alone, whatever the surface.
    const Rgb part = coef * share;
    AmbientRays rays(tracer_, ray, kind, cached ? coef : part, cached ? share : 1, request.context);
    sampling.tells = rays.tells_groups();
    const RandomStream before = ray.random;
    RandomStream stream = cached ? stream_of(request.query, options.seed) : ray.random.child();
    if (cached) ray.random = stream.child();
    ++request.context.path.ambient_level;
    if (request.context.ambient.missing == nullptr) ++request.context.counters.ambient.computed;
    Hemisphere hemisphere = sample_hemisphere(request.query.normal, sampling, stream, rays);
    hemisphere.groups = rays.groups();
    --request.context.path.ambient_level;
    if (cached) ray.random = before;
    if (!hemisphere.complete() && request.context.ambient.missing == nullptr)
        ++request.context.counters.ambient.incomplete;
    return hemisphere;
}

Rgb AmbientCalculation::without_cache(const Request& request) const {
    const RenderOptions& options = tracer_.options();
    const auto peak = static_cast<double>(max_component(request.coef));
    const auto none = [&] { return told_constant(request.ray, request.coef, request.context); };
    if (peak <= kEpsilon) return none();
    const double weight = request.query.weight;
    const double most =
        0.8 * peak * weight / (options.ambient_divisions * options.weight_limit + 1e-20);
    const int per_axis = divisions(std::min(weight, most), false);
    if (per_axis == 1) return by_one_ray(request);
    if (coefficients_ && request.context.contributions) {
        const std::optional<Rgb> sum = coefficients_->seen(request, per_axis);
        return sum ? *sum : none();
    }
    const Hemisphere h = sample(request, request.coef, std::min(weight, most), false);
    if (h.succeeded == 0) return none();
    if (request.context.asks_coefficients()) return h.sum;
    const float factor = tilt_factor(h, request.query.shading_normal);
    tell_groups(request, Rgb::grey(factor), h.groups);
    return h.sum * factor;
}

/// What each light group adds to the light at a point, times `coef`, but for that of the path.
void AmbientCalculation::tell_groups(const Request& request, const Rgb& coef,
                                     std::span<const Rgb> values) {
    GroupSums* sums = request.context.groups;
    if (!sums || request.ray.aimed) return;
    sums->add(path_throughput(request.ray, sums->root()) * coef, values);
}

/// A hemisphere of one division. Most are, once paths have branched: no memory is asked for.
Rgb AmbientCalculation::by_one_ray(const Request& request) const {
    TraceContext& context = request.context;
    const bool counts = context.ambient.missing == nullptr;
    const RandomStream stream = request.ray.random.child();
    if (counts) ++context.counters.ambient.computed;
    GroupSums::Part told(context.groups);  // nothing where the ray sees nothing
    Ray ray;
    bool seen = tracer_.spawn(ray, request.far_side ? kAmbientThrough : kAmbientSame, request.ray,
                              &request.coef);
    if (seen) {
        ray.direction = sample_direction(request.query.normal, stream);
        ++context.path.ambient_level;
        const Hit hit = tracer_.scene().geometry().intersect(ray.segment());
        tracer_.shade_hits({&ray, 1}, {&hit, 1}, context);
        --context.path.ambient_level;
        seen = ray.effective_distance() > kEpsilon;
    }
    if (seen) {
        told.keep();
        return ray.value * ray.coef;
    }
    if (counts) ++context.counters.ambient.incomplete;
    return told_constant(request.ray, request.coef, context);
}

AmbientSum AmbientCalculation::known(const Request& request) const {
    return cache_->lookup(request.query,
                          [&](const Vec3& target) { return is_blocked(request.ray, target); });
}

Rgb AmbientCalculation::with_cache(const Request& request) const {
    if (const std::optional<Rgb> value = interpolated(request)) return *value;
    if (MissingAmbient* missing = request.context.ambient.missing) {
        if (can_stand_alone(request.ray))
            missing->points.push_back(point_of(request));
        else if (request.query.level == 0)
            missing->left_out = true;
        return {};
    }
    const Claimed claimed(*cache_, request.query);
    if (claimed.waited()) {
        ++request.context.counters.ambient.waits;
        if (const std::optional<Rgb> value = interpolated(request)) return *value;
    }
    return new_value(request);
}

/// From the cache's values; nothing where none serves.
std::optional<Rgb> AmbientCalculation::interpolated(const Request& request) const {
    const auto mean = [](const std::array<double, 3>& sum, double weight) {
        Rgb value;
        for (std::size_t k = 0; k < 3; ++k) value[k] = static_cast<float>(sum[k] / weight);
        return value;
    };
    AmbientSum sum;
    if (!request.context.groups) {
        sum = known(request);
        if (sum.weight <= kEpsilon) return std::nullopt;
    } else {
        std::vector<std::array<double, 3>> sums(request.context.groups->size());
        sum = cache_->lookup_groups(
            request.query, [&](const Vec3& target) { return is_blocked(request.ray, target); },
            sums);
        if (sum.weight <= kEpsilon) return std::nullopt;
        std::vector<Rgb> values;
        values.reserve(sums.size());
        for (const auto& of_group : sums) values.push_back(mean(of_group, sum.weight));
        tell_groups(request, request.coef, values);
    }
    ++request.context.counters.ambient.interpolated;
    return request.coef * mean(sum.sum, sum.weight);
}

Rgb AmbientCalculation::new_value(const Request& request) const {
    const std::optional<NewValue> made = make_value(request);
    if (!made) return told_constant(request.ray, request.coef, request.context);
    float factor = 1;
    if (made->record) {
        store(request, *made);
        const AmbientQuery& query = request.query;
        if (dot(query.normal, query.shading_normal) < kAligned)
            factor = static_cast<float>(
                extrapolated(DecodedRecord(*made->record), {}, query.shading_normal));
    }
    tell_groups(request, request.coef * factor, made->groups);
    return request.coef * made->value * factor;
}

void AmbientCalculation::store(const Request& request, const NewValue& made) const {
    TraceContext& context = request.context;
    const AmbientRecord& record = *made.record;
    if (context.ambient.new_records != nullptr) {
        if (can_stand_alone(request.ray))
            context.ambient.new_records->new_records.push_back(
                {point_of(request), record, made.groups});
        return;
    }
    if (known(request).weight > kEpsilon) ++context.counters.ambient.duplicates;
    if (made.groups.empty())
        cache_->insert(record);
    else
        cache_->insert_with_groups(record, made.groups);
}

/// What an evaluation weighs: it decides how far its value reaches, and for whom it is good enough.
double AmbientCalculation::evaluation_weight(const AmbientQuery& query) {
    const double weight = std::pow(kReflectance, query.level);
    return query.weight < 0.1 * weight ? 1.25 * query.weight : weight;
}

/// It decides on the number of samples.
double AmbientCalculation::sampling_weight(const AmbientQuery& query) const {
    const double weight = evaluation_weight(query),
                 fewest = kFewestDeeper / (weight * tracer_.options().ambient_divisions);
    return weight * std::clamp(fewest, std::pow(kDeeperShare, query.level), 1.0);
}

std::optional<AmbientCalculation::NewValue> AmbientCalculation::make_value(
    const Request& request) const {
    const AmbientQuery& query = request.query;
    const double weight = evaluation_weight(query);
    const Hemisphere h = sample(request, Rgb::grey(kReflectance), sampling_weight(query), true);
    if (h.succeeded == 0) return std::nullopt;
    NewValue made{h.sum * static_cast<float>(1 / kReflectance), std::nullopt, h.groups};
    for (Rgb& value : made.groups) value *= static_cast<float>(1 / kReflectance);
    if (!h.complete()) return made;
    const AmbientLimits& limits = cache_->limits();
    const AmbientDerivatives d =
        derive(h, {limits.accuracy, limits.least_radius, limits.most_radius, weight});
    if (!(d.radius[0] > kEpsilon)) return made;
    AmbientRecord& record = made.record.emplace();
    for (std::size_t k = 0; k < 3; ++k) record.position[k] = static_cast<float>(query.position[k]);
    record.normal = encode_direction(h.normal);
    record.axis = encode_direction(d.u);
    record.radius = floats(d.radius);
    record.translation = floats(d.translation);
    record.rotation = floats(d.rotation);
    record.value = made.value;
    record.weight = static_cast<float>(weight);
    record.corral = d.corral;
    record.level = static_cast<std::uint8_t>(std::min(query.level, 255));
    return made;
}

bool AmbientCalculation::is_served(const AmbientPoint& point) const {
    const Ray ray = ray_to(point);
    const AmbientSum sum =
        cache_->lookup(point.query, [&](const Vec3& target) { return is_blocked(ray, target); });
    return sum.weight > kEpsilon;
}

std::optional<AmbientRecord> AmbientCalculation::record_at(const AmbientPoint& point,
                                                           TraceContext& context) const {
    Ray ray = ray_to(point);
    const AtLevel at_level(context, point.query.level);
    const std::optional<NewValue> made =
        make_value({ray, Rgb::grey(kReflectance), point.query, point.far_side, context});
    if (!made) return std::nullopt;
    if (context.groups) context.groups->add({1, 1, 1}, made->groups);
    return made->record;
}

void AmbientCalculation::prefetch(const AmbientPoint& point, TraceContext& context) const {
    Ray ray = ray_to(point);
    const AtLevel at_level(context, point.query.level);
    (void)sample({ray, Rgb::grey(kReflectance), point.query, point.far_side, context},
                 Rgb::grey(kReflectance), sampling_weight(point.query), true);
}

/// Whether an opaque surface stands between the hit and `target`.
bool AmbientCalculation::is_blocked(const Ray& ray, const Vec3& target) const {
    const Scene& scene = tracer_.scene();
    Vec3 from = ray.hit.position;
    const Vec3 direction = normalize(target - from);
    double left = length(target - from);
    for (int passed = 0; passed < LightTransport::kMaxDepth && left > kEpsilon; ++passed) {
        const Hit hit = scene.geometry().intersect({from, direction, left});
        if (!hit.exists()) return false;
        const bool clipped = ray.clip && ray.clip->contains(hit.modifier);
        if (!clipped && scene.material_of(hit.modifier) && !scene.is_transparent(hit.modifier))
            return true;
        from = hit.position;
        left -= hit.t;
    }
    return false;
}

}  // namespace lightwalk
