// Direct light where a few of many sources stand for all. Where ambient rays arrive each point is
// one of hundreds in a hemisphere's mean, to which a shadow ray more adds less than another point
// would: there the candidates are chosen from once more. The samples of a pixel share its lights
// among themselves.
#include <algorithm>
#include <span>

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

/// Whether so many of a point's lights bring something that those of a pixel's samples are chosen.
bool is_worth_choosing(std::span<const float> sizes, std::size_t wanted) {
    const auto none = static_cast<std::size_t>(std::count(sizes.begin(), sizes.end(), 0.0f));
    return sizes.size() - none > kManyLights * wanted;
}

}  // namespace

/// A few real sources, and all virtual ones: most of their samples pass the redirecting surface by.
std::span<const std::uint32_t> DirectCalculation::choose_sources(ShadingPoint& point) {
    const std::span<const std::int32_t> sampled = lights_.sampled();
    scratch_.choice.sizes.resize(sampled.size());
    scratch_.choice.scales.assign(lights_.all().size(), 1);
    lights_.boxes().rate(scratch_.gather.views, point.one_sided, scratch_.choice.sizes);
    const std::size_t wanted = wanted_lights(point);
    if (point.sampled && !is_worth_choosing(scratch_.choice.sizes, wanted)) {
        point.chosen = point.sampled = false;
        return lights_.each();
    }
    choose_lights(scratch_.choice.sizes, wanted, random_of(point, 0), scratch_.choice.chosen);
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
    if (point.count <= wanted_lights(point)) return;
    scratch_.choice.sizes.clear();
    for (std::size_t i = 0; i < point.count; ++i) {
        const LightCandidate& candidate = ranked(point, i);
        const LightSource& source = lights_[candidate.source];
        scratch_.choice.sizes.push_back(candidate.state == CandidateState::unknown
                                            ? brightness(candidate.coefficient) * source.worth
                                            : candidate.brightness * visible_share(source));
    }
    choose_lights(scratch_.choice.sizes, wanted_lights(point), random_of(point, 1),
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
