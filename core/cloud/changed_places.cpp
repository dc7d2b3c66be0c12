#include "core/cloud/changed_places.h"

#include <algorithm>

#include "core/geometry/bounds.h"

namespace lightwalk {
namespace {

/// So far around its box a surface's light and shadow are looked for, as a share of its diagonal.
constexpr double kAround = 0.5;

}  // namespace

ChangedPlaces::ChangedPlaces(const std::vector<Bounds>& surfaces, const Vec3& eye) : eye_(eye) {
    for (const Bounds& box : outline_of(surfaces)) {
        const double margin = kAround * length(box.upper - box.lower);
        places_.push_back({box, grown(box, margin)});
        extend(all_.surfaces, box);
        extend(all_.around, places_.back().around);
    }
}

bool ChangedPlaces::touches(const Place& place, const Vec3& point) const {
    if (contains(place.around, point)) return true;
    const Vec3 way = point - eye_;
    const double distance = length(way);
    if (!(distance > 0)) return true;
    const std::optional<double> entered = entry(place.surfaces, eye_, way * (1 / distance));
    return entered && *entered < distance;
}

bool ChangedPlaces::may_touch(const CloudPoint& point) const {
    if (places_.empty()) return false;
    if (point.kind == PointKind::mirrored) return true;
    const Vec3 place = point.place();
    return touches(all_, place) &&
           std::ranges::any_of(places_, [&](const Place& one) { return touches(one, place); });
}

}  // namespace lightwalk
