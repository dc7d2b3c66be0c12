// The direct calculation's shadow tests.
#include <algorithm>
#include <numeric>

#include "core/light/direct_calculation.h"
#include "core/transport/light_groups.h"

namespace lightwalk {
namespace {

/// Whether the light is behind the true surface.
bool goes_through(const Ray& ray, const Vec3& direction) {
    return (ray.hit.cos_out > 0) != (dot(direction, ray.hit.normal) > 0);
}

void set_dark(LightCandidate& candidate) {
    candidate.state = CandidateState::dark;
    candidate.contribution = Rgb{};
}

void set_seen(LightCandidate& candidate) {
    candidate.state =
        candidate.state == CandidateState::unknown ? CandidateState::seen : CandidateState::lit;
}

}  // namespace

void DirectCalculation::test() {
    scratch_.tests.clear();
    for (const ShadingPoint& point : scratch_.points) {
        for (std::size_t i = point.tested; i < point.block_end; ++i)
            scratch_.tests.push_back(scratch_.ranks[point.first + i]);
    }
    context_.counters.rays.shadow += scratch_.tests.size();
    test_plainly();
    for (const std::uint32_t i : scratch_.tests) {
        if (scratch_.candidates[i].needs_shading) trace_shadow(scratch_.candidates[i]);
    }
    find_radiances(scratch_.tests, CandidateState::seen);
}

/// What lies between, where a ray that only asks for opaque surfaces can tell; the other candidates
/// become ones that need shading.
void DirectCalculation::test_plainly() {
    const Geometry& geometry = tracer_.scene().geometry();
    if (scratch_.points.size() == 1) {
        for (const std::uint32_t i : scratch_.tests) {
            LightCandidate& candidate = scratch_.candidates[i];
            if (mark_needs_shading(candidate)) continue;
            const ShadowQuery query = shadow_query(candidate);
            take(candidate, geometry.visibility(query.ray, query.target, query.last));
        }
        return;
    }
    sort_by_source();
    scratch_.shadows.queries.clear();
    for (const std::uint32_t i : scratch_.shadows.candidates)
        scratch_.shadows.queries.push_back(shadow_query(scratch_.candidates[i]));
    scratch_.shadows.answers.resize(scratch_.shadows.queries.size());
    // Only rays from neighbouring points to the same source are coherent; what ambient rays meet
    // lies anywhere.
    constexpr std::size_t kWorthPackets = 8;
    const bool coherent = !scratch_.points.front().ray->in(kAmbient);
    std::size_t first = 0;
    for (const std::uint32_t last : scratch_.shadows.ends) {
        const auto queries = std::span(scratch_.shadows.queries).subspan(first, last - first);
        const auto answers = std::span(scratch_.shadows.answers).subspan(first, last - first);
        if (coherent && queries.size() >= kWorthPackets) {
            geometry.visibility(queries, answers);
        } else {
            for (std::size_t i = 0; i < queries.size(); ++i)
                answers[i] =
                    geometry.visibility(queries[i].ray, queries[i].target, queries[i].last);
        }
        first = last;
    }
    for (std::size_t k = 0; k < scratch_.shadows.candidates.size(); ++k)
        take(scratch_.candidates[scratch_.shadows.candidates[k]], scratch_.shadows.answers[k]);
}

/// Whether the candidate has to be traced in any case.
bool DirectCalculation::mark_needs_shading(LightCandidate& candidate) const {
    const LightSource& source = lights_[candidate.source];
    // What is known of a virtual source is what it brings, not by which coefficient.
    candidate.needs_shading = needs_tracing(source, point_of(candidate)) ||
                              (context_.asks_coefficients() && source.is_virtual());
    return candidate.needs_shading;
}

/// Order the candidates that are tested by their source. Those that have to be traced in any case
/// become ones that need shading.
void DirectCalculation::sort_by_source() {
    std::vector<std::uint32_t>& ends = scratch_.shadows.ends;
    ends.assign(lights_.all().size(), 0);
    for (const std::uint32_t i : scratch_.tests) {
        LightCandidate& candidate = scratch_.candidates[i];
        if (!mark_needs_shading(candidate)) ++ends[static_cast<std::size_t>(candidate.source)];
    }
    std::exclusive_scan(ends.begin(), ends.end(), ends.begin(), 0U);
    scratch_.shadows.candidates.resize(scratch_.tests.size());
    std::size_t plain = 0;
    for (const std::uint32_t i : scratch_.tests) {
        const LightCandidate& candidate = scratch_.candidates[i];
        if (candidate.needs_shading) continue;
        scratch_.shadows.candidates[ends[static_cast<std::size_t>(candidate.source)]++] = i;
        ++plain;
    }
    scratch_.shadows.candidates.resize(plain);
}

ShadowQuery DirectCalculation::shadow_query(const LightCandidate& candidate) {
    const LightSource& source = lights_[candidate.source];
    const ShadingPoint& point = point_of(candidate);
    const bool local = !source.is_distant() || source.is_virtual();
    ShadowQuery query;
    query.ray = {point.position, candidate.direction, local ? candidate.distance : kHuge};
    query.target = local ? source.object : kNoSurface;
    // Rays through the surface keep what is left to the aft clipping plane.
    if (point.limited && goes_through(*point.ray, candidate.direction)) {
        const double end = farthest_hit(point.ray->limit - point.ray->hit.t);
        if (end < query.ray.t_max) {
            query.ray.t_max = end;
            query.target = kNoSurface;
        }
    }
    query.last = &shared_.blockers[static_cast<std::size_t>(candidate.source)];
    return query;
}

void DirectCalculation::take(LightCandidate& candidate, Visibility found) const {
    if (context_.observer && found == Visibility::clear) found = Visibility::needs_shading;
    switch (found) {
        case Visibility::clear:
            set_seen(candidate);
            break;
        case Visibility::blocked:
            set_dark(candidate);
            break;
        case Visibility::needs_shading:
            candidate.needs_shading = true;
    }
}

/// Follow one shadow ray through whatever is in the way.
void DirectCalculation::trace_shadow(LightCandidate& candidate) {
    const ShadingPoint& point = point_of(candidate);
    Ray& ray = *point.ray;
    Ray shadow;
    const RayKind kind = goes_through(ray, candidate.direction) ? kShadowThrough : kShadowSame;
    (void)tracer_.spawn(shadow, kind, ray, nullptr);
    shadow.direction = candidate.direction;
    shadow.coef = candidate.coefficient;
    shadow.target = candidate.source;
    const GroupSums::Turned turned(context_.groups, point.account);
    GroupSums::Part told(context_.groups);  // nothing where the light counts as none
    tracer_.trace(shadow, context_);
    if (!shadow.hit.exists()) {  // at the aft clipping plane: what lies beyond does not shadow
        candidate.needs_shading = false;
        set_seen(candidate);
    } else if (static_cast<double>(mean(shadow.value)) > kEpsilon) {
        candidate.state = CandidateState::lit;
        candidate.contribution = candidate.coefficient * shadow.value;
        told.keep();
    } else {
        set_dark(candidate);
    }
}

}  // namespace lightwalk
