#include "parallel/walk/cloud_region.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/cloud/point_order.h"
#include "core/cloud/reuse_error_controller.h"
#include "core/math/prefetch.h"
#include "parallel/blocks.h"
#include "parallel/walk/step_timer.h"

namespace lightwalk {
namespace {

constexpr std::size_t kPointsATask = 16384;
constexpr int kBlockSide = 64;  ///< of the pixels that a task answers
constexpr int kHalo = 1;        ///< pixels around the region whose points may answer its own

std::size_t tasks_for(std::size_t count) {
    return (count + kPointsATask - 1) / kPointsATask;
}

float relative_error(const Rgb& value, const Rgb& truth) {
    const float is = brightness(value), should = brightness(truth);
    return std::abs(is - should) / std::max(should, 1e-9f);
}

}  // namespace

PixelRectangle widened(const PixelRectangle& area, int by, int width, int height) {
    if (area.empty()) return {};
    return {std::max(area.x0 - by, 0), std::max(area.y0 - by, 0), std::min(area.x1 + by, width),
            std::min(area.y1 + by, height)};
}

CloudRegion::CloudRegion(const PixelRectangle& area, int width, int height,
                         const CloudOptions& options)
    : area_(area),
      width_(width),
      height_(height),
      options_(options),
      grids_(widened(area, kHalo, width, height)),
      blocks_(make_blocks(area, kBlockSide)) {}

void CloudRegion::begin(const Camera& camera, const CloudRules& rules) {
    rules_ = rules;
    reuse_ = tightened(options_.rules, rules.tightness);
    projector_.emplace(camera, width_, height_);
    const std::size_t pixels = area_.pixels();
    frame_.radiance.resize(pixels);
    frame_.distance.resize(pixels);
    frame_.causes.resize(pixels);
    known_.resize(pixels);
    if (options_.refine > 0) origins_.resize(pixels);
    frame_.complete = false;
    frame_.report = {};
    frame_.report.pixels = pixels;
    frame_.report.tightness = rules.tightness;
    uncached_.clear();
    noise_pairs_.clear();
    finest_ = finest_grid();
    unanswered_ = left_ = answered_ = 0;
    expect_uncached();
}

/// So fine that a few times as many uncached pixels are noted as the last frame had time to trace.
int CloudRegion::finest_grid() const {
    constexpr std::size_t kEnough = 1024, kMoreThanTraced = 3;
    int level = 0;
    if (!(options_.budget > 0)) return kGridLevels - 1;
    for (std::size_t noted = left_ >> (2 * (kGridLevels - 1));
         noted < kEnough + kMoreThanTraced * answered_ && level < kGridLevels - 1; noted *= 4)
        ++level;
    return level;
}

void CloudRegion::project(Executor& executor) {
    const StepTimer timer(frame_.report.project_seconds);
    places_.resize(points_.size());
    used_.assign(points_.size(), 0);
    const std::size_t cells = grids_.ahead.size();
    executor.for_each(tasks_for(cells), [&](std::size_t task, int) {
        const std::size_t first = task * kPointsATask;
        const std::size_t last = std::min(first + kPointsATask, cells);
        grids_.ahead.clear(first, last);
        grids_.mirrored.clear(first, last);
    });
    executor.for_each(tasks_for(points_.size()), [&](std::size_t task, int) {
        const std::size_t first = task * kPointsATask;
        project_points(*projector_, points_, first, std::min(first + kPointsATask, points_.size()),
                       grids_, places_);
    });
}

/// Of these pixels no other region needs points.
PixelRectangle CloudRegion::inside_of_area() const {
    PixelRectangle inner = area_;
    if (area_.x0 > 0) inner.x0 += kHalo;
    if (area_.y0 > 0) inner.y0 += kHalo;
    if (area_.x1 < width_) inner.x1 -= kHalo;
    if (area_.y1 < height_) inner.y1 -= kHalo;
    return inner;
}

void CloudRegion::add(std::span<const CloudPoint> points) {
    const StepTimer timer(frame_.report.project_seconds);
    const std::size_t first = points_.size();
    points_.insert(points_.end(), points.begin(), points.end());
    places_.resize(points_.size());
    used_.resize(points_.size());
    project_points(*projector_, points_, first, points_.size(), grids_, places_);
}

/// None of them is traced. What earlier frames left in `traced_` does no harm, and clearing it
/// takes a millisecond.
void CloudRegion::expect_uncached() {
    if (traced_.size() < uncached_.size()) traced_.resize(uncached_.size());
    done_.assign(uncached_.size(), 0);
    pair_radiance_.resize(noise_pairs_.size());
    pair_done_.assign(noise_pairs_.size(), 0);
}

void CloudRegion::refine(std::span<const PixelPlace> places) {
    std::fill(frame_.causes.begin(), frame_.causes.end(), TraceCause::none);
    for (const PixelPlace& place : places) uncached_.push_back({place, TraceCause::refined});
    expect_uncached();
}

UsedPixels CloudRegion::used_beside() const {
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

void CloudRegion::mark_used(const UsedPixels& used) {
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

void CloudRegion::record(std::size_t first, std::span<const TracedPixelResult> traced) {
    std::copy(traced.begin(), traced.end(), traced_.begin() + static_cast<std::ptrdiff_t>(first));
    std::fill_n(done_.begin() + static_cast<std::ptrdiff_t>(first), traced.size(), std::uint8_t{1});
}

void CloudRegion::record_noise_pairs(std::size_t first, std::span<const TracedPixelResult> traced) {
    for (std::size_t i = 0; i < traced.size(); ++i) {
        pair_radiance_[first + i] = traced[i].value.radiance;
        pair_done_[first + i] = 1;
    }
}

void CloudRegion::show() {
    CloudReport& report = frame_.report;
    report.reused = report.pixels - unanswered_;
    for (std::size_t i = 0; i < noise_pairs_.size(); ++i) {
        if (pair_done_[i] == 0 || done_[noise_pairs_[i]] == 0) continue;
        report.audit_floors.push_back(
            relative_error(pair_radiance_[i], traced_[noise_pairs_[i]].value.radiance));
    }
    for (std::size_t i = 0; i < uncached_.size(); ++i) {
        if (done_[i] == 0) continue;
        const UncachedPixel& uncached_pixel = uncached_[i];
        const std::size_t at = pixel(uncached_pixel.place);
        const PixelValue& traced = traced_[i].value;
        if (uncached_pixel.cause == TraceCause::audited)
            report.audit_errors.push_back(relative_error(frame_.radiance[at], traced.radiance));
        else
            ++answered_;
        frame_.radiance[at] = traced.radiance;
        frame_.distance[at] = traced.distance;
        frame_.causes[at] = uncached_pixel.cause;
        known_[at] = 1;
        if (!origins_.empty()) origins_[at] = {PixelOrigin::Kind::traced, 1, 0};
        ++report.uncached[static_cast<std::size_t>(uncached_pixel.cause)];
    }
    report.filled = unanswered_ - answered_;
}

void CloudRegion::leave_points() {
    fresh_.clear();
    for (std::size_t i = 0; i < uncached_.size(); ++i) {
        if (done_[i] == 0) continue;
        const PixelPoints& left = traced_[i].points;
        fresh_.insert(fresh_.end(), left.points.begin(),
                      left.points.begin() + static_cast<std::ptrdiff_t>(left.count));
    }
}

AgeCounts CloudRegion::age(Executor& executor) {
    const StepTimer timer(frame_.report.keep_seconds);
    leave_points();
    kept_.resize(points_.size());
    const int age = static_cast<int>(std::ceil(options_.age * rules_.tightness));
    const CloudLife life{age, options_.supersaturated};
    const std::size_t tasks = tasks_for(points_.size());
    std::vector<AgeCounts> counts(tasks);
    const auto part = [&](std::size_t task, auto& whole) {
        const std::size_t first = task * kPointsATask;
        return std::span(whole).subspan(first, std::min(kPointsATask, whole.size() - first));
    };
    const bool whole = area_ == PixelRectangle{0, 0, width_, height_};
    executor.for_each(tasks, [&](std::size_t task, int) {
        const auto places = part(task, places_);
        const auto used = part(task, used_);
        for (std::size_t i = 0; i < places.size() && !whole; ++i) {
            // What lies outside is another region's.
            if (!(places[i].distance > 0) || area_.contains(pixel_of(places[i], width_, height_)))
                continue;
            places[i] = {};
            used[i] = 0;
        }
        counts[task] = age_points(part(task, points_), used, places, life, part(task, kept_));
    });
    AgeCounts all{};
    all[0] = fresh_.size();
    for (const AgeCounts& one : counts)
        for (std::size_t i = 0; i < all.size(); ++i) all[i] += one[i];
    return all;
}

AgeCounts CloudRegion::rest(bool leave) {
    fresh_.clear();
    if (leave) leave_points();
    kept_.assign(points_.size(), 1);
    AgeCounts all{};
    all[0] = fresh_.size();
    for (const CloudPoint& point : points_) ++all[point.age];
    return all;
}

/// New points take the places of those that go, and then the last ones do.
void CloudRegion::keep(const AgeLimit& room, Executor& executor) {
    const StepTimer timer(frame_.report.keep_seconds);
    const auto stays = [&](const CloudPoint& point) {
        return point.age < room.age ||
               (point.age == room.age && lot(point, rules_.frame) >= room.share);
    };
    if (room.age == 0) std::erase_if(fresh_, [&](const CloudPoint& p) { return !stays(p); });
    std::vector<std::vector<std::uint32_t>> going(tasks_for(points_.size()));
    executor.for_each(going.size(), [&](std::size_t task, int) {
        const std::size_t first = task * kPointsATask;
        const std::size_t last = std::min(first + kPointsATask, points_.size());
        for (std::size_t i = first; i < last; ++i)
            if (kept_[i] == 0 || !stays(points_[i]))
                going[task].push_back(static_cast<std::uint32_t>(i));
    });
    std::vector<std::uint32_t> gaps;
    for (const std::vector<std::uint32_t>& part : going)
        gaps.insert(gaps.end(), part.begin(), part.end());
    const std::size_t filled = std::min(gaps.size(), fresh_.size());
    for (std::size_t i = 0; i < filled; ++i) points_[gaps[i]] = fresh_[i];
    std::size_t end = points_.size(), last_gap = gaps.size();
    for (std::size_t i = filled; i < last_gap; ++i) {
        while (last_gap > i && gaps[last_gap - 1] == end - 1) --last_gap, --end;
        if (i < last_gap) points_[gaps[i]] = points_[--end];
    }
    points_.resize(end);
    points_.insert(points_.end(), fresh_.begin() + static_cast<std::ptrdiff_t>(filled),
                   fresh_.end());
    fresh_.clear();
    frame_.report.points = points_.size();
}

}  // namespace lightwalk
