#include "core/cloud/sleeping_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace lightwalk {
namespace {

/// Small enough that hardly any points wake in vain, large enough that boxes are few.
constexpr std::size_t kGroup = 128;
constexpr int kCodeBits = 10;  ///< of a place in each direction

/// Spreads the lowest bits so that two bits are free beside each.
std::uint32_t spread(std::uint32_t x) {
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
}

Bounds bounds_of(std::span<const CloudPoint> points) {
    Bounds box;
    for (const CloudPoint& point : points) box.extend(point.place());
    return box;
}

/// Codes of places in a box, so that places whose codes are near lie near each other: Morton, "A
/// computer oriented geodetic data base", IBM 1966.
class PlaceCode {
  public:
    explicit PlaceCode(const Bounds& box) : lower_(box.lower) {
        const Vec3 size = box.upper - box.lower;
        const double largest = std::max({size.x, size.y, size.z, kEpsilon});
        scale_ = ((1 << kCodeBits) - 1) / largest;
    }
    std::uint32_t operator()(const Vec3& place) const {
        const Vec3 at = (place - lower_) * scale_;
        return spread(static_cast<std::uint32_t>(at.x)) |
               spread(static_cast<std::uint32_t>(at.y)) << 1 |
               spread(static_cast<std::uint32_t>(at.z)) << 2;
    }

  private:
    Vec3 lower_;
    double scale_;
};

/// Whether a point is of the background.
bool is_far(const CloudPoint& point) {
    constexpr float kFar = 1e8f;  // [m]
    return std::max({std::abs(point.position[0]), std::abs(point.position[1]),
                     std::abs(point.position[2])}) > kFar;
}

/// @param some  numbers of points
void sort_by_place(std::span<const CloudPoint> points, std::span<std::uint32_t> some) {
    Bounds box;
    for (const std::uint32_t i : some) box.extend(points[i].place());
    const PlaceCode code(box);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    order.reserve(some.size());
    for (const std::uint32_t i : some) order.emplace_back(code(points[i].place()), i);
    std::ranges::sort(order);
    std::ranges::transform(order, some.begin(), [](const auto& one) { return one.second; });
}

}  // namespace

void SleepingPoints::add(std::span<const CloudPoint> points, std::span<const Rgb> groups) {
    const std::size_t count = points.empty() ? 0 : groups.size() / points.size();
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    // The background is so far away that beside it all else would have one code.
    const auto far = std::stable_partition(order.begin(), order.end(),
                                           [&](std::uint32_t i) { return !is_far(points[i]); });
    for (const std::span<std::uint32_t> some :
         {std::span(order.begin(), far), std::span(far, order.end())}) {
        if (some.empty()) continue;
        sort_by_place(points, some);
        for (std::size_t first = 0; first < some.size(); first += kGroup) {
            Group& group = groups_.emplace_back();
            for (const std::uint32_t i :
                 some.subspan(first, std::min(kGroup, some.size() - first))) {
                group.points.push_back(points[i]);
                const auto own = groups.subspan(i * count, count);
                group.groups.insert(group.groups.end(), own.begin(), own.end());
            }
            group.box = bounds_of(group.points);
        }
    }
    size_ += points.size();
}

void SleepingPoints::wake(const PointProjector& projector, std::size_t most,
                          std::vector<CloudPoint>& awake, std::vector<Rgb>& groups) {
    constexpr std::uint8_t kNotJustShown = 1;
    bool any = false;
    for (auto group = groups_.rbegin(); group != groups_.rend() && awake.size() < most; ++group) {
        if (!projector.may_show(group->box.lower, group->box.upper)) continue;
        for (CloudPoint point : group->points) {
            point.age = kNotJustShown;
            awake.push_back(point);
        }
        groups.insert(groups.end(), group->groups.begin(), group->groups.end());
        size_ -= group->points.size();
        group->points.clear();
        any = true;
    }
    if (any) std::erase_if(groups_, [](const Group& group) { return group.points.empty(); });
}

void SleepingPoints::drop(const ShownMaterials& materials) {
    for (Group& group : groups_) {
        size_ -= group.points.size();
        drop_points(materials, group.points, group.groups);
        size_ += group.points.size();
    }
    std::erase_if(groups_, [](const Group& group) { return group.points.empty(); });
}

void SleepingPoints::limit(std::size_t most) {
    while (size_ > most) {
        size_ -= groups_.front().points.size();
        groups_.pop_front();
    }
}

}  // namespace lightwalk
