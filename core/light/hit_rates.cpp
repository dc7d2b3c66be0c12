#include "core/light/hit_rates.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/light/direct_calculation.h"
#include "core/light/light_walk.h"
#include "core/light/partition.h"

namespace lightwalk {
namespace {

constexpr std::size_t kShadowRays = 10000;  ///< that the measurement may cost
constexpr std::size_t kLeastPoints = 64, kMostPoints = 2000;
constexpr std::size_t kRound = 32, kRoundParts = 4;  ///< points, and parts of a round
constexpr double kPriorShare =
    0.02;  ///< weight of what all tests say against what the untested ones say
constexpr int kFitSteps = 3;

/// Sums of light: what gets through, and what an estimate expects.
struct Ledger {
    double visible = 0, expected = 0;
    [[nodiscard]] float ratio(double fallback) const {
        return static_cast<float>(
            std::clamp(expected > 0 ? visible / expected : fallback, 0.0, 1.0));
    }
};

/// Share of the light of all tests that gets through, by source.
std::vector<Ledger> count_all(const std::vector<MeasuredPoint>& points, std::size_t sources) {
    std::vector<Ledger> all(sources);
    for (const MeasuredPoint& point : points) {
        for (const MeasuredCandidate& c : point) {
            Ledger& ledger = all[static_cast<std::size_t>(c.source)];
            ledger.expected += static_cast<double>(c.brightness);
            ledger.visible += static_cast<double>(c.arriving);
        }
    }
    return all;
}

std::vector<float> remaining_sums_of(const MeasuredPoint& point) {
    std::vector<float> remaining_sums(point.size() + 1, 0.0f);
    for (std::size_t i = point.size(); i-- > 0;)
        remaining_sums[i] = remaining_sums[i + 1] + point[i].brightness;
    return remaining_sums;
}

/// What the direct calculation would leave untested at a point, entered by source.
void count_untested(const MeasuredPoint& point, const std::vector<float>& rates, double certainty,
                    double threshold, std::vector<Ledger>& untested) {
    const std::vector<float> remaining_sums = remaining_sums_of(point);
    ShadowTally tally;
    const auto test = [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            tally.hits += point[i].arriving > 0 ? 1 : 0;
            tally.expected += static_cast<double>(rates[static_cast<std::size_t>(point[i].source)]);
            tally.brightness += point[i].arriving;
        }
    };
    const std::size_t tested = test_brightest(remaining_sums, certainty, threshold, tally, test);
    for (std::size_t i = tested; i < point.size(); ++i) {
        const auto source = static_cast<std::size_t>(point[i].source);
        const auto share = static_cast<double>(point[i].brightness);
        const double rate = std::max(1e-3, static_cast<double>(rates[source]));
        untested[source].expected += share * std::min(1 / rate, tally.factor());
        untested[source].visible += static_cast<double>(point[i].arriving);
    }
}

/// The candidates of a diffuse surface at the hit, all tested.
MeasuredPoint measure(const LightSources& lights, const Hit& hit, const RandomStream& random,
                      TraceContext& context) {
    Ray ray = context.tracer.primary(hit.position + hit.normal, -hit.normal, 0, random);
    ray.hit = hit;
    ray.hit.t = ray.hit.cos_out = 1;
    const auto coefficient = one_by_one([&hit](const Vec3& l, double omega) {
        const double cosine = dot(hit.normal, l);
        return cosine > 0 ? Rgb::grey(static_cast<float>(cosine * omega)) : Rgb{};
    });
    DirectCalculation direct(lights, context);
    const DirectRequest request{&ray, coefficient};
    direct.gather({&request, 1});
    ShadingPoint& lit = direct.point(0);
    lit.adaptive = true;
    direct.sort();
    lit.block_end = lit.count;
    direct.test();
    MeasuredPoint point;
    const float total = direct.remaining_sums(lit)[0];
    for (std::size_t i = 0; i < lit.count; ++i) {
        const LightCandidate& c = direct.ranked(lit, i);
        point.push_back({c.source, c.brightness / total, brightness(c.contribution) / total});
    }
    return point;
}

/// The most candidates that one point can have.
std::size_t most_candidates(const LightSources& lights, const RenderOptions& options) {
    std::size_t count = 0;
    for (const std::int32_t i : lights.sampled()) {
        const bool divided = options.source_subdivision > kEpsilon &&
                             (lights[i].is_flat() || lights[i].is_cylinder());
        count += divided ? kMaxParts : 1;
    }
    return count;
}

}  // namespace

std::vector<float> fit_hit_rates(const std::vector<MeasuredPoint>& points, std::size_t sources,
                                 double certainty, double threshold) {
    const std::vector<Ledger> all = count_all(points, sources);
    std::vector<float> overall(sources);
    for (std::size_t i = 0; i < sources; ++i) overall[i] = all[i].ratio(0.5);
    std::vector<float> rates = overall;
    for (int step = 0; step < kFitSteps; ++step) {
        std::vector<Ledger> untested(sources);
        for (const MeasuredPoint& point : points)
            count_untested(point, rates, certainty, threshold, untested);
        for (std::size_t i = 0; i < sources; ++i) {
            const double prior = kPriorShare * all[i].expected;
            untested[i].visible += prior * static_cast<double>(overall[i]);
            untested[i].expected += prior;
            rates[i] = untested[i].ratio(0.5);
        }
    }
    return rates;
}

std::vector<float> measure_hit_rates(const LightSources& lights, const LightTransport& tracer,
                                     WarningSink& warnings, const TaskRunner& task_runner) {
    const RenderOptions& options = tracer.options();
    if (most_candidates(lights, options) <= kFirstBlock) return {};
    const std::vector<Hit> places = walk_light(lights, tracer, kMostPoints);
    std::vector<std::unique_ptr<TraceContext>> contexts(kRoundParts);
    for (auto& context : contexts) context = std::make_unique<TraceContext>(tracer, warnings);
    std::vector<MeasuredPoint> points(places.size());
    std::size_t count = 0, rays = 0;
    const auto is_enough = [&] { return rays >= kShadowRays && count >= kLeastPoints; };
    // Rounds: what is measured beyond enough does not count, so that the task runner's size does
    // not.
    for (std::size_t first = 0; first < places.size() && !is_enough(); first += kRound) {
        const std::size_t last = std::min(first + kRound, places.size());
        task_runner.run(kRoundParts, [&](std::size_t part) {
            for (std::size_t i = first + part; i < last; i += kRoundParts) {
                const RandomStream random(mix_bits(options.seed ^ mix_bits(i)));
                points[i] = measure(lights, places[i], random, *contexts[part]);
            }
        });
        for (; count < last && !is_enough(); ++count) rays += points[count].size();
    }
    points.resize(count);
    return fit_hit_rates(points, lights.all().size(), options.shadow_certainty,
                         options.shadow_threshold);
}

}  // namespace lightwalk
