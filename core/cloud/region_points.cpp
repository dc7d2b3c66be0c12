#include "core/cloud/region_points.h"

#include <algorithm>

#include "core/cloud/point_order.h"

namespace lightwalk {
namespace {

/// In a frame not more points a pixel wake than these: what is awake takes time. Those that are
/// awake do not count: of a view that rested they are many, and an eye that turns shows others.
constexpr std::size_t kMostWokenAPixel = 2;

constexpr int kHalo = 1;  ///< pixels around the region whose points may answer its own

bool has_room(const CloudPoint& point, const AgeLimit& room, std::uint64_t frame) {
    return point.age < room.age || (point.age == room.age && lot(point, frame) >= room.share);
}

}  // namespace

RegionPoints::RegionPoints(const PixelRectangle& area, int width, int height)
    : area_(area), width_(width), height_(height), grids_(widened(area, kHalo, width, height)) {}

void RegionPoints::begin(const Camera& camera) {
    projector_.emplace(camera, width_, height_);
    fresh_.clear();
    fresh_groups_.clear();
}

void RegionPoints::mix(const LightMixture& mixture, const TaskRunner& task_runner) {
    if (mixture == mixture_) return;
    mixture_ = mixture;
    for_each_part(task_runner, points_.size(),
                  [&](std::size_t, std::size_t first, std::size_t last) { mix_from(first, last); });
}

/// Points first ... last - 1.
void RegionPoints::mix_from(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last && group_count_ > 0; ++i)
        points_[i].radiance = mixture_.sum(groups_of(i));
}

/// Of two points the second one has what the first one has not.
void RegionPoints::leave_groups(std::size_t points, std::span<const Rgb> groups,
                                std::span<const Rgb> ahead) {
    group_count_ = groups.size();
    if (points == 1) fresh_groups_.insert(fresh_groups_.end(), groups.begin(), groups.end());
    if (points < 2) return;
    fresh_groups_.insert(fresh_groups_.end(), ahead.begin(), ahead.end());
    for (std::size_t g = 0; g < groups.size(); ++g) fresh_groups_.push_back(groups[g] - ahead[g]);
}

void RegionPoints::project(const TaskRunner& task_runner) {
    if (projector_->is_perspective()) {
        const std::size_t awake = points_.size();
        asleep_.wake(*projector_, awake + kMostWokenAPixel * area_.pixels(), points_, groups_);
        mix_from(awake, points_.size());
    }
    places_.resize(points_.size());
    used_.assign(points_.size(), 0);
    for_each_part(task_runner, grids_.ahead.size(),
                  [&](std::size_t, std::size_t first, std::size_t last) {
                      grids_.ahead.clear(first, last);
                      grids_.mirrored.clear(first, last);
                  });
    for_each_part(task_runner, points_.size(),
                  [&](std::size_t, std::size_t first, std::size_t last) {
                      project_points(*projector_, points_, first, last, grids_, places_);
                  });
}

/// Of these pixels no other region needs points.
PixelRectangle RegionPoints::inside_of_area() const {
    PixelRectangle inner = area_;
    if (area_.x0 > 0) inner.x0 += kHalo;
    if (area_.y0 > 0) inner.y0 += kHalo;
    if (area_.x1 < width_) inner.x1 -= kHalo;
    if (area_.y1 < height_) inner.y1 -= kHalo;
    return inner;
}

void RegionPoints::add(std::span<const CloudPoint> points, std::span<const Rgb> groups) {
    const std::size_t first = points_.size();
    points_.insert(points_.end(), points.begin(), points.end());
    if (!groups.empty()) group_count_ = groups.size() / points.size();
    groups_.insert(groups_.end(), groups.begin(), groups.end());
    places_.resize(points_.size());
    used_.resize(points_.size());
    project_points(*projector_, points_, first, points_.size(), grids_, places_);
}

UsedPixels RegionPoints::used_beside() const {
    UsedPixels used;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (used_[i] == 0) continue;
        const PixelPlace place = pixel_of(places_[i], width_, height_);
        if (area_.contains(place)) continue;
        const bool mirrored = points_[i].kind == PointKind::mirrored;
        (mirrored ? used.mirrored : used.ahead).push_back(place);
    }
    return used;
}

void RegionPoints::mark_used(const UsedPixels& used) {
    const auto mark_winners = [&](const std::vector<PixelPlace>& places, const DepthGrid& grid) {
        for (const PixelPlace& place : places) {
            if (!area_.contains(place)) continue;
            const std::uint32_t index = grid.winner(place.x, place.y);
            if (index != kNoPoint) used_[index] = 1;
        }
    };
    mark_winners(used.ahead, grids_.ahead);
    mark_winners(used.mirrored, grids_.mirrored);
}

AgeCounts RegionPoints::age(const CloudLife& life, const TaskRunner& task_runner) {
    fates_.resize(points_.size());
    CloudLife own_life = life;
    if (!projector_->is_perspective()) own_life.awake = 0;  // they could not be woken
    std::vector<AgeCounts> counts(part_count(points_.size()));
    std::vector<std::vector<std::uint32_t>> tired(counts.size());
    const bool whole = area_ == PixelRectangle{0, 0, width_, height_};
    for_each_part(task_runner, points_.size(),
                  [&](std::size_t part, std::size_t first, std::size_t last) {
                      for (std::size_t i = first; i < last && !whole; ++i) {
                          // What lies outside is another region's.
                          if (!(places_[i].distance > 0) ||
                              area_.contains(pixel_of(places_[i], width_, height_)))
                              continue;
                          places_[i].distance = -1;
                          used_[i] = 0;
                      }
                      const auto own = [&](auto& of_all) {
                          return std::span(of_all).subspan(first, last - first);
                      };
                      counts[part] =
                          age_points(own(points_), own(used_), own(places_), own_life, own(fates_));
                      for (std::size_t i = first; i < last; ++i)
                          if (fates_[i] == PointFate::sleeps)
                              tired[part].push_back(static_cast<std::uint32_t>(i));
                  });
    put_to_sleep(tired);
    AgeCounts sum{};
    sum[0] = fresh_.size();
    for (const AgeCounts& one : counts)
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += one[i];
    return sum;
}

/// @param parts  numbers of points
void RegionPoints::put_to_sleep(std::span<const std::vector<std::uint32_t>> parts) {
    std::vector<CloudPoint> tired;
    std::vector<Rgb> groups;
    for (const std::vector<std::uint32_t>& part : parts)
        for (const std::uint32_t i : part) {
            tired.push_back(points_[i]);
            points_[i].kind = PointKind::gone;
            const std::span<const Rgb> own = groups_of(i);
            groups.insert(groups.end(), own.begin(), own.end());
        }
    asleep_.add(tired, groups);
}

AgeCounts RegionPoints::rest() {
    fates_.assign(points_.size(), PointFate::stays);
    AgeCounts counts{};
    counts[0] = fresh_.size();
    for (const CloudPoint& point : points_) ++counts[point.age];
    return counts;
}

void RegionPoints::replace(std::size_t to, std::span<const CloudPoint> others,
                           std::span<const Rgb> groups, std::size_t from) {
    points_[to] = others[from];
    if (group_count_ > 0)
        std::ranges::copy(groups.subspan(from * group_count_, group_count_),
                          groups_.begin() + static_cast<std::ptrdiff_t>(to * group_count_));
}

void RegionPoints::drop_old_fresh(const AgeLimit& room, std::uint64_t frame) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < fresh_.size(); ++i) {
        if (!has_room(fresh_[i], room, frame)) continue;
        fresh_[kept] = fresh_[i];
        for (std::size_t g = 0; g < group_count_; ++g)
            fresh_groups_[kept * group_count_ + g] = fresh_groups_[i * group_count_ + g];
        ++kept;
    }
    fresh_.resize(kept);
    fresh_groups_.resize(kept * group_count_);
}

/// New points take the places of those that go, and then the last ones do.
void RegionPoints::keep(const AgeLimit& room, std::uint64_t frame, const TaskRunner& task_runner) {
    const auto stays = [&](const CloudPoint& point) { return has_room(point, room, frame); };
    if (room.age == 0) drop_old_fresh(room, frame);
    std::vector<std::vector<std::uint32_t>> going(part_count(points_.size()));
    for_each_part(task_runner, points_.size(),
                  [&](std::size_t part, std::size_t first, std::size_t last) {
                      for (std::size_t i = first; i < last; ++i)
                          if (fates_[i] != PointFate::stays || !stays(points_[i]))
                              going[part].push_back(static_cast<std::uint32_t>(i));
                  });
    std::vector<std::uint32_t> gaps;
    for (const std::vector<std::uint32_t>& part : going)
        gaps.insert(gaps.end(), part.begin(), part.end());
    const std::size_t filled = std::min(gaps.size(), fresh_.size());
    for (std::size_t i = 0; i < filled; ++i) replace(gaps[i], fresh_, fresh_groups_, i);
    std::size_t end = points_.size(), last_gap = gaps.size();
    for (std::size_t i = filled; i < last_gap; ++i) {
        while (last_gap > i && gaps[last_gap - 1] == end - 1) --last_gap, --end;
        if (i < last_gap) replace(gaps[i], points_, groups_, --end);
    }
    points_.resize(end);
    groups_.resize(end * group_count_);
    groups_.insert(groups_.end(),
                   fresh_groups_.begin() + static_cast<std::ptrdiff_t>(filled * group_count_),
                   fresh_groups_.end());
    fresh_groups_.clear();
    points_.insert(points_.end(), fresh_.begin() + static_cast<std::ptrdiff_t>(filled),
                   fresh_.end());
    fresh_.clear();
}

}  // namespace lightwalk
