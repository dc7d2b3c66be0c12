// Direct light on surfaces: the stages and what is between them.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/light/direct_calculation.h"
#include "core/transport/contribution.h"
#include "core/transport/light_groups.h"

namespace lightwalk {
namespace {

/// Of points and sources at a time: each may have up to kMaxParts candidates.
constexpr std::size_t kMostPairs = std::size_t{1} << 14;

LightScratch& scratch_of(TraceContext& context) {
    if (!context.light) context.light = make_opaque<LightScratch>();
    return *context.light;
}

DirectScratch& open_scratch(LightScratch& scratch) {
    if (scratch.open == scratch.nested.size()) scratch.nested.emplace_back();
    return scratch.nested[scratch.open++];
}

/// A number that is the less the brighter a candidate is, then the earlier it was found. The bits
/// of positive floats are ordered as they are.
std::uint64_t rank_key(float brightness, std::uint32_t candidate) {
    return std::uint64_t{~std::bit_cast<std::uint32_t>(brightness)} << 32 | candidate;
}

}  // namespace

DirectCalculation::DirectCalculation(const LightSources& lights, TraceContext& context)
    : lights_(lights),
      tracer_(context.tracer),
      context_(context),
      shared_(scratch_of(context)),
      scratch_(open_scratch(shared_)) {
    scratch_.points.clear();
    scratch_.candidates.clear();
    scratch_.ranks.clear();
    shared_.blockers.resize(lights.all().size());
}

DirectCalculation::~DirectCalculation() {
    --shared_.open;
}

std::span<const float> DirectCalculation::remaining_sums(const ShadingPoint& point) const {
    const auto number = static_cast<std::size_t>(&point - scratch_.points.data());
    return std::span(scratch_.remaining_sums).subspan(point.first + number, point.count + 1);
}

void DirectCalculation::run(std::span<const DirectRequest> requests) {
    gather(requests);
    for (ShadingPoint& point : scratch_.points) {
        if (point.chosen && !point.sampled) choose_candidates(point);
        plan(point);
    }
    sort();
    while (select_tests()) {
        test();
        for (ShadingPoint& point : scratch_.points) sum_tested(point);
    }
    for (ShadingPoint& point : scratch_.points) add_untested(point);
}

/// Which of the point's candidates are to be tested, and in which order.
void DirectCalculation::plan(ShadingPoint& point) {
    const RenderOptions& options = tracer_.options();
    bool all = options.shadow_threshold <= 0 || point.sampled || point.count <= kFirstBlock ||
               context_.asks_coefficients();
    for (std::size_t i = 0; i < point.count && !all && point.count <= kFewPatterned; ++i)
        all = ranked(point, i).state == CandidateState::unknown;
    point.adaptive = !all;
    point.tally.brightness = brightness(point.ray->value);
}

void DirectCalculation::sort() {
    scratch_.tests.clear();
    const bool told = context_.observer != nullptr;  // of the brightest first
    bool any = false;
    for (const ShadingPoint& point : scratch_.points) {
        if (!point.adaptive && !told) continue;
        any = true;
        for (std::size_t i = 0; i < point.count; ++i)
            scratch_.tests.push_back(scratch_.ranks[point.first + i]);
    }
    if (!any) return;
    find_radiances(scratch_.tests, CandidateState::unknown);
    scratch_.remaining_sums.resize(scratch_.candidates.size() + scratch_.points.size());
    for (ShadingPoint& point : scratch_.points) {
        if (point.adaptive || told) rank(point);
    }
}

void DirectCalculation::rank(ShadingPoint& point) {
    std::vector<std::uint64_t>& keys = scratch_.keys;
    keys.clear();
    for (std::size_t i = 0; i < point.count; ++i) {
        const std::uint32_t candidate = scratch_.ranks[point.first + i];
        const LightCandidate& c = scratch_.candidates[candidate];
        if (c.state != CandidateState::dark) keys.push_back(rank_key(c.brightness, candidate));
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i)
        scratch_.ranks[point.first + i] = static_cast<std::uint32_t>(keys[i]);
    point.count = keys.size();
    point.ahead = look_ahead(point.count, tracer_.options().shadow_certainty);
    const auto number = static_cast<std::size_t>(&point - scratch_.points.data());
    float* const tail = scratch_.remaining_sums.data() + point.first + number;
    tail[point.count] = 0;
    for (std::size_t i = point.count; i-- > 0;) tail[i] = tail[i + 1] + ranked(point, i).brightness;
}

/// The next block of every point. False: nothing is left to be tested.
bool DirectCalculation::select_tests() {
    bool any = false;
    const double threshold = tracer_.options().shadow_threshold;
    for (ShadingPoint& point : scratch_.points) {
        point.block_end = point.adaptive ? next_block(remaining_sums(point), point.ahead,
                                                      threshold / point.ray->weight, point.tested,
                                                      point.tally.brightness)
                                         : point.count;
        any = any || point.block_end > point.tested;
    }
    return any;
}

void DirectCalculation::sum_tested(ShadingPoint& point) {
    if (point.tested == point.block_end) return;
    if (context_.contributions) tell_tested(point, *context_.contributions);
    Rgb& value = point.ray->value;
    for (; point.tested < point.block_end; ++point.tested) {
        const LightCandidate& candidate = ranked(point, point.tested);
        value += candidate.contribution;
        point.tally.hits += candidate.state == CandidateState::lit ? 1 : 0;
        point.tally.expected += static_cast<double>(lights_[candidate.source].hit_rate);
    }
    point.tally.brightness = brightness(value);
}

/// The contributions that sum_tested() adds, but for those of traced shadow rays: these have told
/// of what they met.
void DirectCalculation::tell_tested(const ShadingPoint& point, ContributionSink& sink) const {
    if (point.ray->aimed) return;
    const GroupSums::Turned turned(context_.groups, point.account);
    const Rgb throughput = path_throughput(*point.ray, sink.root());
    for (std::size_t i = point.tested; i < point.block_end; ++i) {
        const LightCandidate& candidate = ranked(point, i);
        if (candidate.needs_shading || candidate.state != CandidateState::lit) continue;
        const LightSource& source = lights_[candidate.source];
        const bool distant = source.is_distant();
        const Vec3 position =
            distant ? point.position : point.position + candidate.direction * candidate.distance;
        const Rgb left = transmittance(point.ray->medium, candidate.distance, true);
        tell({emitter_of(source), candidate.direction, position,
              throughput * candidate.coefficient * left, throughput * candidate.contribution},
             sink);
    }
}

void DirectCalculation::add_untested(ShadingPoint& point) {
    if (point.tested == point.count) return;
    const auto factor = static_cast<float>(point.tally.factor());
    for (std::size_t i = point.tested; i < point.count; ++i) {
        const LightCandidate& candidate = ranked(point, i);
        const Rgb value =
            candidate.contribution * std::min(1.0f, factor * lights_[candidate.source].hit_rate);
        point.ray->value += value;
        if (context_.groups) tell_guess(point, candidate, value, *context_.groups);
    }
}

/// Light that is assumed to arrive: as much of a source's as of those that were tested.
void DirectCalculation::tell_guess(const ShadingPoint& point, const LightCandidate& candidate,
                                   const Rgb& value, GroupSums& sink) const {
    if (point.ray->aimed) return;
    const GroupSums::Turned turned(&sink, point.account);
    const Rgb throughput = path_throughput(*point.ray, sink.root());
    tell({emitter_of(lights_[candidate.source]),
          candidate.direction,
          {},
          throughput,
          throughput * value},
         sink);
}

/// The modifier of the surface that emits, also where others redirect its light.
ModifierId DirectCalculation::emitter_of(const LightSource& source) const {
    const LightSource* real = &source;
    while (real->is_virtual()) real = &lights_[real->parent];
    return tracer_.scene().surface(real->object).modifier();
}

void LightSources::add_direct(std::span<const DirectRequest> requests,
                              TraceContext& context) const {
    if (sampled_.empty() || context.ambient.missing != nullptr) return;
    const std::size_t together = std::max<std::size_t>(1, kMostPairs / sampled_.size());
    for (std::size_t first = 0; first < requests.size(); first += together) {
        DirectCalculation direct(*this, context);
        direct.run(requests.subspan(first, std::min(together, requests.size() - first)));
    }
}

}  // namespace lightwalk
