#include "core/ambient/coefficient_calculation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/transport/contribution.h"

namespace lightwalk {
namespace {

/// Of hemispheres that look for missing records: so few that places where nobody looks are hardly
/// worth one.
constexpr int kLookingDivisions = 3;
constexpr int kFewestOfRecords = 6;  ///< divisions of a record's hemisphere
constexpr int kFiner = 3;            ///< rays per axis of a cell next to light
constexpr double kEnclosed = 0.75;   ///< share of directions beside a record that are blocked
constexpr double kClearance = 0.7;   ///< of the way to what is beside a record, that it reaches
constexpr double kBeside = 0.7;      ///< sine of the angle to the normal from where things are that
constexpr int kProbes = 6;           ///< per axis: rays that look what is around

}  // namespace

CoefficientCalculation::CoefficientCalculation(const LightTransport& tracer,
                                               const CoefficientCache& cache)
    : tracer_(tracer), cache_(cache) {
    const Scene& scene = tracer.scene();
    lets_light_.resize(scene.modifier_count());
    for (std::size_t i = 0; i < lets_light_.size(); ++i) {
        const ModifierId id{static_cast<std::int32_t>(i)};
        if (!scene.modifier(id).node) continue;  // no surface has it
        const std::optional<ModifierId> material = scene.material_of(id);
        const bool emits = material && is_light(scene.modifier(*material).type);
        lets_light_[i] = emits || scene.is_transparent(id) ? 1 : 0;
    }
}

std::optional<Rgb> CoefficientCalculation::known(const AmbientRequest& request) const {
    TraceContext& context = request.context;
    if (!context.coefficients) context.coefficients = make_opaque<CoefficientScratch>();
    std::vector<RecordShare>& shares = context.coefficients->shares;
    cache_.find(request.query, shares);
    if (!shares.empty()) {
        ++context.counters.ambient.interpolated;
        const Rgb coefficient =
            path_throughput(request.ray, context.contributions->root()) * request.coef;
        Rgb value;
        for (const RecordShare& share : shares) {
            const auto part = static_cast<float>(share.weight);
            value += cache_.value(share.record) * part;
            context.contributions->add_record(share.record, coefficient * part);
        }
        return request.coef * value;
    }
    MissingAmbient* const missing = context.ambient.missing;
    if (!missing) return std::nullopt;
    if (can_stand_alone(request.ray) && request.ray.limit <= 0) {
        AmbientPoint& point = missing->points.emplace_back(point_of(request));
        point.path_length += std::exchange(point.distance, 0);  // whose medium is not the point's
        point.query.weight = kAssumedReflectance;  // who asks does not decide what is kept
    }
    return Rgb{};
}

std::optional<Rgb> CoefficientCalculation::seen(const AmbientRequest& request,
                                                int divisions) const {
    RefinedHemisphere::Sampling sampling;
    const bool looks = request.context.ambient.missing != nullptr;
    sampling.divisions = looks ? std::min(divisions, kLookingDivisions) : divisions;
    // The rays' limits go by their parts in the sum.
    sampling.coef =
        request.coef * (1 / static_cast<float>(sampling.divisions * sampling.divisions));
    sampling.random = request.ray.random.child();
    const Surroundings found = sample(request, sampling);
    return found.succeeded > 0 ? std::optional(found.sum) : std::nullopt;
}

Surroundings CoefficientCalculation::sample(const AmbientRequest& request,
                                            RefinedHemisphere::Sampling sampling) const {
    TraceContext& context = request.context;
    sampling.normal = request.query.normal;
    sampling.kind = request.kind();
    if (!context.ambient.missing) {
        sampling.finer = kFiner;
        ++context.counters.ambient.computed;
    }
    const AtLevel below(context, context.path.ambient_level + 1);
    return RefinedHemisphere(tracer_, lets_light_, request.ray, sampling, context).sample();
}

bool CoefficientCalculation::is_served(const AmbientPoint& point,
                                       CoefficientScratch& scratch) const {
    cache_.find(point.query, scratch.shares);
    return !scratch.shares.empty();
}

/// By what is around, not by how bright it is: records that happen to see less light than there is
/// would reach farther than others.
/// Source: Ward, Rubinstein & Clear 1988 (the harmonic mean of distances).
std::optional<double> CoefficientCalculation::reach_at(const AmbientPoint& point) const {
    const AmbientQuery& query = point.query;
    RandomStream random = stream_of(query, ~tracer_.options().seed);
    const HemisphereFrame frame(query.normal, random);
    double nearness = 0, nearest = kHuge;
    int beside = 0, blocked = 0;
    for (int i = 0; i < kProbes * kProbes; ++i) {
        const int row = i / kProbes, column = i % kProbes;
        const double x = column + random.next(), y = row + random.next();
        const DiskPoint at = square_to_disk(x / kProbes, y / kProbes);
        const double sine = std::hypot(at.x, at.y);
        if (sine > kBeside) ++beside;
        const Hit hit = tracer_.scene().geometry().intersect(
            {query.position, frame.above(at), farthest_hit(0)});
        if (!hit.exists()) continue;
        nearness += 1 / std::max(hit.t, kEpsilon);
        if (sine <= kBeside) continue;
        ++blocked;
        nearest = std::min(nearest, hit.t * sine);
    }
    if (blocked < kEnclosed * beside) return std::nullopt;
    const AmbientLimits& limits = cache_.limits();
    const double mean_distance = kProbes * kProbes / (nearness + kEpsilon);
    const double wanted =
        limits.accuracy * std::clamp(mean_distance, limits.least_radius, limits.most_radius);
    return std::max(cache_.least_reach(), std::min(wanted, kClearance * nearest));
}

std::optional<CoefficientRecord> CoefficientCalculation::record_at(const AmbientPoint& point,
                                                                   double reach,
                                                                   TraceContext& context) const {
    Ray ray = ray_to(point);
    const RenderOptions& options = tracer_.options();
    const double samples = options.ambient_divisions * cache_.effort() * ray.weight;
    RefinedHemisphere::Sampling sampling;
    sampling.divisions = std::clamp(static_cast<int>(std::min(std::sqrt(samples) + 0.5, 1000.0)),
                                    kFewestOfRecords, 1000);
    sampling.coef = Rgb::grey(kAssumedReflectance);
    sampling.share = 1 / static_cast<float>(sampling.divisions * sampling.divisions);
    sampling.random = stream_of(point.query, options.seed);
    ray.random = sampling.random.child();
    const AtLevel at_level(context, point.query.level);
    const Surroundings found =
        sample({ray, sampling.coef, point.query, point.far_side, context}, sampling);
    if (found.succeeded == 0) return std::nullopt;
    return CoefficientRecord{point.query.position, point.query.normal, reach,
                             found.sum * static_cast<float>(1 / kAssumedReflectance)};
}

}  // namespace lightwalk
