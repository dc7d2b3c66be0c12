#include "core/cloud/changed_places.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/geometry/bounds.h"

namespace lightwalk {
namespace {

/// What is so far from a surface's box gets light by way of it, as a share of its diagonal. Farther
/// away that is little, and is there once the view rests.
constexpr double kAround = 0.1;

/// Whether the way from one place to another one meets a box.
bool is_between(const Bounds& box, const Vec3& from, const Vec3& to) {
    const Vec3 way = to - from;
    const double distance = length(way);
    if (!(distance > 0)) return true;
    const std::optional<double> entered = entry(box, from, way * (1 / distance));
    return entered && *entered < distance;
}

}  // namespace

ChangedPlaces::ChangedPlaces(const std::vector<Bounds>& surfaces, const Vec3& eye,
                             std::vector<ShadowSource> sources)
    : eye_(eye), sources_(std::move(sources)) {
    for (const Bounds& box : outline_of(surfaces)) {
        const double margin = kAround * length(box.upper - box.lower);
        places_.push_back({box, grown(box, margin)});
        extend(all_.surfaces, box);
        extend(all_.around, places_.back().around);
    }
}

bool ChangedPlaces::touches(const Place& place, const Vec3& point) const {
    return contains(place.around, point) || is_between(place.surfaces, eye_, point) ||
           std::ranges::any_of(
               sources_, [&](const ShadowSource& source) { return shades(place, point, source); });
}

bool ChangedPlaces::shades(const Place& place, const Vec3& point, const ShadowSource& source) {
    if (source.distant) return entry(place.surfaces, point, source.place).has_value();
    return is_between(place.surfaces, point, source.place);
}

bool ChangedPlaces::may_touch(const CloudPoint& point) const {
    if (places_.empty()) return false;
    if (point.kind == PointKind::mirrored) return true;
    const Vec3 place = point.place();
    return touches(all_, place) &&
           std::ranges::any_of(places_, [&](const Place& one) { return touches(one, place); });
}

}  // namespace lightwalk
