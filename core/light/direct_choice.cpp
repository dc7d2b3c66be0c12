// Direct light where ambient rays arrive: of many sources, and then of many candidates, a few stand
// for all. Each such point is one of hundreds in a hemisphere's mean, to which a shadow ray more
// adds less than another point would.
#include <algorithm>

#include "core/light/direct_calculation.h"

namespace lightwalk {
namespace {

/// Numbers of a point's own, for the choice of sources (0) and candidates (1).
double random_of(const ShadingPoint& point, int choice) {
    RandomStream stream = point.start.random;
    RandomStream child = stream.child();
    for (int i = 0; i < choice; ++i) child = stream.child();
    return child.next();
}

}  // namespace

/// A few real sources, and all virtual ones: most of their samples pass the redirecting surface by.
std::span<const std::uint32_t> DirectCalculation::choose_sources(const ShadingPoint& point) {
    const std::span<const std::int32_t> sampled = lights_.sampled();
    scratch_.choice.sizes.resize(sampled.size());
    scratch_.choice.scales.assign(lights_.all().size(), 1);
    lights_.boxes().rate(scratch_.gather.views, point.one_sided, scratch_.choice.sizes);
    choose_lights(scratch_.choice.sizes, wanted_lights(), random_of(point, 0),
                  scratch_.choice.chosen);
    std::vector<std::uint32_t>& which = scratch_.choice.sources;
    which.clear();
    for (const LightChoice& choice : scratch_.choice.chosen) {
        scratch_.choice.scales[static_cast<std::size_t>(sampled[choice.which])] = choice.scale;
        which.push_back(choice.which);
    }
    if (lights_.virtual_count() == 0) return which;
    for (const std::uint32_t k : lights_.each())
        if (lights_[sampled[k]].is_virtual()) which.push_back(k);
    return which;
}

/// Of the point's candidates a few, which bring more for it.
void DirectCalculation::choose_candidates(ShadingPoint& point) {
    if (point.count <= wanted_lights()) return;
    scratch_.choice.sizes.clear();
    for (std::size_t i = 0; i < point.count; ++i) {
        const LightCandidate& candidate = ranked(point, i);
        const LightSource& source = lights_[candidate.source];
        scratch_.choice.sizes.push_back(candidate.state == CandidateState::unknown
                                            ? brightness(candidate.coefficient) * source.worth
                                            : candidate.brightness * visible_share(source));
    }
    choose_lights(scratch_.choice.sizes, wanted_lights(), random_of(point, 1),
                  scratch_.choice.chosen);
    for (std::size_t i = 0; i < scratch_.choice.chosen.size(); ++i) {
        const LightChoice& choice = scratch_.choice.chosen[i];
        std::uint32_t& place = scratch_.ranks[point.first + i];
        std::swap(place, scratch_.ranks[point.first + choice.which]);
        LightCandidate& candidate = scratch_.candidates[place];
        candidate.coefficient *= choice.scale;
        candidate.contribution *= choice.scale;
        candidate.brightness *= choice.scale;
    }
    point.count = scratch_.choice.chosen.size();
}

}  // namespace lightwalk
