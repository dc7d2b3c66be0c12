#pragma once
// How often each source's shadow tests get through, measured once and frozen, so that a point's
// direct light does not depend on which points were computed before.
#include <vector>

#include "core/light/light_sources.h"
#include "core/math/task_runner.h"

namespace lightwalk {

/// What one light sample brings to a point where visibility is measured. Both figures are shares of
/// the direct light that the point would have without shadows.
struct MeasuredCandidate {
    std::int32_t source = 0;
    float brightness = 0;  ///< contribution without shadows
    float arriving = 0;    ///< contribution that shadows and transparent surfaces leave
};

/// All light samples of one measured point, brightest first.
using MeasuredPoint = std::vector<MeasuredCandidate>;

/// The hit rate of each source for which the shares of light that -dt leaves untested come out
/// right in the mean over the points: the visible share of what would be left untested over what
/// the estimate makes of it.
/// @param certainty, threshold  -dc, -dt
[[nodiscard]] std::vector<float> fit_hit_rates(const std::vector<MeasuredPoint>& points,
                                               std::size_t sources, double certainty,
                                               double threshold);

/// The hit rate of each source, fitted to points where light arrives: these are found by following
/// light from the sources over a few diffuse bounces with seeded random numbers, and every source
/// is tested from each. Traces a bounded number of rays, some ten thousand. Returns nothing when
/// -dt never leaves anything untested: then the rates do not matter.
[[nodiscard]] std::vector<float> measure_hit_rates(const LightSources& lights,
                                                   const LightTransport& tracer,
                                                   WarningSink& warnings,
                                                   const TaskRunner& task_runner);

}  // namespace lightwalk
