#include "core/cloud/ageing.h"

#include <algorithm>

namespace lightwalk {

AgeCounts age_points(std::span<CloudPoint> points, std::span<const std::uint8_t> used,
                     std::span<const ImagePlace> places, const CloudLife& life,
                     std::span<std::uint8_t> keep) {
    AgeCounts counts{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        CloudPoint& point = points[i];
        keep[i] = 0;
        if (point.kind == PointKind::gone) continue;
        const bool useful = used[i] != 0;
        point.age = useful ? 0 : static_cast<std::uint8_t>(std::min(point.age + 1, kOldestAge));
        point.old = static_cast<std::uint8_t>(std::min(point.old + 1, kOldestAge));
        const bool stays =
            useful || (life.supersaturated && point.age <= life.age && places[i].distance > 0);
        if (!stays) {
            point.kind = PointKind::gone;
            continue;
        }
        keep[i] = 1;
        ++counts[point.age];
    }
    return counts;
}

AgeLimit age_limit(const AgeCounts& counts, std::size_t most) {
    std::size_t kept = 0;
    for (std::size_t age = 0; age < counts.size(); ++age) {
        if (kept + counts[age] > most) return {static_cast<int>(age), kept + counts[age] - most};
        kept += counts[age];
    }
    return {};
}

}  // namespace lightwalk
