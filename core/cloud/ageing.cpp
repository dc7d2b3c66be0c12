#include "core/cloud/ageing.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {

namespace {

/// The limit of lot() below which at least `least` of `all` points lie. Their number is binomial: a
/// margin of seven standard deviations, and a constant for small numbers, makes too few practically
/// impossible.
std::uint32_t share_for(std::size_t least, std::size_t all) {
    constexpr double kSpreads = 7, kFew = 24, kLots = 4294967296.0, kMost = kLots - 1;
    const auto wanted = static_cast<double>(least);
    const double expected = wanted + kSpreads * std::sqrt(wanted) + kFew;
    return static_cast<std::uint32_t>(std::min(kMost, kLots * expected / static_cast<double>(all)));
}

}  // namespace

AgeCounts age_points(std::span<CloudPoint> points, std::span<const std::uint8_t> used,
                     std::span<const ImagePlace> places, const CloudLife& life,
                     std::span<PointFate> fates) {
    AgeCounts counts{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        CloudPoint& point = points[i];
        fates[i] = PointFate::gone;
        if (point.kind == PointKind::gone) continue;
        const bool useful = used[i] != 0;
        point.age = useful ? 0 : static_cast<std::uint8_t>(std::min(point.age + 1, kOldestAge));
        point.old = static_cast<std::uint8_t>(std::min(point.old + 1, kOldestAge));
        const bool shown = places[i].distance > 0;
        const bool away = places[i].distance == 0 && life.awake > 0;
        const bool stays =
            useful ||
            (life.supersaturated && point.age <= (away ? life.awake : life.age) && (shown || away));
        if (!stays && away) {
            fates[i] = PointFate::sleeps;
            continue;
        }
        if (!stays) {
            point.kind = PointKind::gone;
            continue;
        }
        fates[i] = PointFate::stays;
        ++counts[point.age];
    }
    return counts;
}

AgeLimit age_limit(const AgeCounts& counts, std::size_t most) {
    std::size_t kept = 0;
    for (std::size_t age = 0; age < counts.size(); ++age) {
        if (kept + counts[age] > most)
            return {static_cast<int>(age), share_for(kept + counts[age] - most, counts[age])};
        kept += counts[age];
    }
    return {};
}

}  // namespace lightwalk
