#include "parallel/walk/cloud_region.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/cloud/audit.h"
#include "core/cloud/point_order.h"
#include "core/math/prefetch.h"
#include "parallel/blocks.h"
#include "parallel/walk/step_timer.h"

namespace lightwalk {
namespace {

constexpr std::size_t kPointsATask = 16384;
constexpr int kBlockSide = 64;  ///< of the pixels that a task answers
constexpr int kPacketSide = 8;  ///< of those that are looked at together
constexpr std::size_t kPacket = std::size_t{kPacketSide} * kPacketSide;
constexpr int kHalo = 1;  ///< pixels around the region whose points may answer its own

/// Of the tiles: of CloudCheck::rotating, of those where points seem to tell enough.
constexpr double kCheckedShare = 1.0 / 3;

/// Of the audited pixels a second ray tells how much two rays differ.
constexpr double kFloorShare = 0.25;

std::size_t tasks_for(std::size_t count) {
    return (count + kPointsATask - 1) / kPointsATask;
}

/// Many pixels may use one point.
void mark(std::uint8_t& flag) {
    std::atomic_ref<std::uint8_t>(flag).store(1, std::memory_order_relaxed);
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
    frame_.radiance.assign(pixels, {});
    frame_.distance.assign(pixels, 0);
    frame_.causes.assign(pixels, HoleCause::none);
    frame_.complete = false;
    frame_.report = {};
    frame_.report.pixels = pixels;
    frame_.report.tightness = rules.tightness;
    holes_.clear();
    twins_.clear();
    expect_holes();
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

/// What decides whether this frame's audit traces a pixel though it is reused, and whether twice.
RandomStream CloudRegion::audit_stream(const PixelPlace& place) const {
    return RandomStream::of_pixel(options_.seed + rules_.frame + 1,
                                  static_cast<std::uint32_t>(place.x),
                                  static_cast<std::uint32_t>(place.y), 0);
}

void CloudRegion::answer(const PixelCaster& caster, Executor& executor, const StopFlag& stop,
                         Clock::time_point check_until) {
    const StepTimer timer(frame_.report.check_seconds);
    check_until_ = check_until;
    origins_.clear();
    if (options_.refine > 0) origins_.resize(frame_.radiance.size());
    holes_of_.assign(blocks_.size(), {});
    // Where time is short it is that of the last ones: others in each frame.
    const std::size_t first = rules_.frame * (blocks_.size() / 3 + 1);
    executor.for_each(
        blocks_.size(),
        [&](std::size_t block, int worker) {
            answer_block((first + block) % blocks_.size(), caster, worker);
        },
        stop);
    order_holes(holes_of_);
    choose_twins();
    expect_holes();
}

/// Where time is short: the worst first, among equals coarse grids, and another block each frame.
void CloudRegion::order_holes(const std::vector<std::vector<CloudHole>>& of_blocks) {
    const bool hurries = options_.budget > 0;
    const std::size_t blocks = of_blocks.size();
    const std::size_t first = hurries && blocks > 0 ? rules_.frame % blocks : 0;
    const auto rank = [hurries](const CloudHole& hole) {
        if (!hurries) return std::size_t{0};
        return static_cast<std::size_t>(hole.cause) * kGridLevels +
               static_cast<std::size_t>(grid_level(hole.place));
    };
    // There are tens of thousands where the eye turns fast, and one thread that orders them.
    std::array<std::size_t, kHoleCauses * kGridLevels + 1> begin{};
    for (const std::vector<CloudHole>& holes : of_blocks)
        for (const CloudHole& hole : holes) ++begin[rank(hole) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    holes_.resize(begin.back());
    for (std::size_t k = 0; k < blocks; ++k)
        for (const CloudHole& hole : of_blocks[(first + k) % blocks])
            holes_[begin[rank(hole)]++] = hole;
}

void CloudRegion::choose_twins() {
    for (std::size_t i = 0; i < holes_.size(); ++i) {
        if (holes_[i].cause != HoleCause::audited) continue;
        RandomStream random = audit_stream(holes_[i].place);
        (void)random.next();  // has decided that it is audited
        if (random.next() < kFloorShare) twins_.push_back(static_cast<std::uint32_t>(i));
    }
}

/// None of them is traced. What earlier frames left in `traced_` does no harm, and clearing it
/// takes a millisecond.
void CloudRegion::expect_holes() {
    if (traced_.size() < holes_.size()) traced_.resize(holes_.size());
    done_.assign(holes_.size(), 0);
    twin_radiance_.resize(twins_.size());
    twin_done_.assign(twins_.size(), 0);
}

void CloudRegion::refine(std::span<const PixelPlace> places) {
    for (const PixelPlace& place : places) holes_.push_back({place, HoleCause::refined, true});
    expect_holes();
}

/// Whether the lot has rays check all of a pixel's tile. No fixed turn: points that move a tile a
/// frame would then never be checked.
bool CloudRegion::is_checked(const PixelPlace& place) const {
    return RandomStream::of_pixel(options_.seed + rules_.frame + 1,
                                  static_cast<std::uint32_t>(place.x / kPacketSide),
                                  static_cast<std::uint32_t>(place.y / kPacketSide), 1)
               .next() < kCheckedShare;
}

/// A pixel will be answered soon: fetch what is read and written then into the cache.
void CloudRegion::expect(const PixelPlace& place, const PointFinder& finder) const {
    const std::size_t at = pixel(place);
    finder.expect(place);
    prefetch(&frame_.radiance[at]);
    prefetch(&frame_.distance[at]);
    if (!origins_.empty()) prefetch(&origins_[at]);
}

/// Show what a pixel's answer brings, or note that it is a hole.
void CloudRegion::settle(const PixelPlace& place, const PointFinder& finder,
                         const PixelAnswer& answer, std::vector<CloudHole>& holes) {
    const std::size_t at = pixel(place);
    const bool reused = answer.found();
    const bool guessed = !reused && options_.budget > 0 && finder.is_guess(answer);
    if (reused || guessed) {
        frame_.radiance[at] = answer.radiance;
        frame_.distance[at] = finder.distance(answer);
    }
    if (guessed && !origins_.empty()) origins_[at].kind = PixelOrigin::Kind::guessed;
    if (!reused) {
        holes.push_back({place, answer.cause, guessed});
        return;
    }
    for (const std::uint32_t index : {answer.ahead, answer.mirrored})
        if (index != kNoPoint) mark(used_[index]);
    if (!origins_.empty()) {
        const std::uint32_t index = answer.ahead != kNoPoint ? answer.ahead : answer.mirrored;
        const int fresh = index != kNoPoint ? kOldestAge - points_[index].old : 0;
        origins_[at] = {PixelOrigin::Kind::reused, 0, static_cast<std::uint32_t>(fresh)};
    }
    if (options_.audit > 0 && audit_stream(place).next() < options_.audit)
        holes.push_back({place, HoleCause::audited, true});
}

/// What is read and written afterwards is fetched into the cache while rays are cast: writes are
/// done in order, so that one that misses holds up all after it.
void CloudRegion::answer_packet(std::span<const PixelPlace> places, const PointFinder& finder,
                                const PixelCaster& caster, int worker,
                                std::vector<CloudHole>& holes) {
    std::array<PixelSights, 2 * kPacket> sights;
    std::array<PixelAnswer, 2 * kPacket> answers;
    for (const PixelPlace& place : places) expect(place, finder);
    caster.look(places, {sights.data(), places.size()}, worker);
    finder.checked(places, {sights.data(), places.size()}, answers);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (answers[i].ahead != kNoPoint) prefetch(&used_[answers[i].ahead]);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (sights[i].ray) settle(places[i], finder, answers[i], holes);
}

/// Answer those pixels of a tile that the last frame's surfaces seem to go through.
/// @return  the number of those left, which are moved to the front
std::size_t CloudRegion::answer_steady(std::span<PixelPlace> tile, const PointFinder& finder,
                                       std::vector<CloudHole>& holes) {
    std::array<PixelAnswer, kPacket> answers;
    for (const PixelPlace& place : tile) expect(place, finder);
    finder.steady(tile, answers);
    for (std::size_t i = 0; i < tile.size(); ++i)
        if (answers[i].found()) prefetch(&used_[answers[i].ahead]);
    std::size_t left = 0;
    for (std::size_t i = 0; i < tile.size(); ++i) {
        if (answers[i].found())
            settle(tile[i], finder, answers[i], holes);
        else
            tile[left++] = tile[i];
    }
    return left;
}

/// Answer those pixels of a tile that no ray checks.
/// @return  the number of those left, which are moved to the front
std::size_t CloudRegion::answer_freely(std::span<PixelPlace> tile, const PointFinder& finder,
                                       std::vector<CloudHole>& holes) {
    if (!rules_.empty && options_.check == CloudCheck::all) return tile.size();
    if (!rules_.empty && options_.check == CloudCheck::rotating) {
        const bool late = Clock::now() > check_until_;
        if (!late && is_checked(tile.front())) return tile.size();
        const std::size_t left = answer_steady(tile, finder, holes);
        if (!late) return left;
        for (const PixelPlace& place : tile.first(left))
            settle(place, finder, finder.glimpsed(place), holes);
        return 0;
    }
    std::size_t left = 0;
    for (const PixelPlace& place : tile) {
        if (!rules_.empty && options_.check == CloudCheck::edges && finder.is_edge(place))
            tile[left++] = place;
        else
            settle(place, finder, finder.unchecked(place), holes);
    }
    return left;
}

void CloudRegion::answer_block(std::size_t block, const PixelCaster& caster, int worker) {
    const PointFinder finder(*projector_, points_, grids_, places_, reuse_);
    const PixelRectangle& area = blocks_[block];
    std::vector<CloudHole>& holes = holes_of_[block];
    std::array<PixelPlace, 2 * kPacket> places;
    std::size_t count = 0;
    const auto check = [&] {
        if (count > 0) answer_packet({places.data(), count}, finder, caster, worker, holes);
        count = 0;
    };
    for (int y0 = area.y0 - area.y0 % kPacketSide; y0 < area.y1; y0 += kPacketSide) {
        for (int x0 = area.x0 - area.x0 % kPacketSide; x0 < area.x1; x0 += kPacketSide) {
            PixelPlace* const tile = places.data() + count;
            std::size_t pixels = 0;
            for (int y = std::max(y0, area.y0); y < std::min(y0 + kPacketSide, area.y1); ++y)
                for (int x = std::max(x0, area.x0); x < std::min(x0 + kPacketSide, area.x1); ++x)
                    tile[pixels++] = {x, y};
            count += answer_freely({tile, pixels}, finder, holes);
            if (count >= kPacket) check();
        }
    }
    check();
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

void CloudRegion::take(std::size_t first, std::span<const TracedHole> traced) {
    std::copy(traced.begin(), traced.end(), traced_.begin() + static_cast<std::ptrdiff_t>(first));
    std::fill_n(done_.begin() + static_cast<std::ptrdiff_t>(first), traced.size(), std::uint8_t{1});
}

void CloudRegion::take_twins(std::size_t first, std::span<const TracedHole> traced) {
    for (std::size_t i = 0; i < traced.size(); ++i) {
        twin_radiance_[first + i] = traced[i].value.radiance;
        twin_done_[first + i] = 1;
    }
}

void CloudRegion::show() {
    CloudReport& report = frame_.report;
    report.reused = report.pixels;
    for (std::size_t i = 0; i < twins_.size(); ++i) {
        if (twin_done_[i] == 0 || done_[twins_[i]] == 0) continue;
        report.audit_floors.push_back(
            relative_error(twin_radiance_[i], traced_[twins_[i]].value.radiance));
    }
    for (std::size_t i = 0; i < holes_.size(); ++i) {
        const CloudHole& hole = holes_[i];
        const bool audited = hole.cause == HoleCause::audited;
        const std::size_t at = pixel(hole.place);
        if (!audited) {
            --report.reused;
            frame_.causes[at] = hole.cause;
        }
        if (done_[i] == 0) {
            if (!audited) ++report.filled;
            continue;
        }
        const PixelValue& traced = traced_[i].value;
        if (audited)
            report.audit_errors.push_back(relative_error(frame_.radiance[at], traced.radiance));
        frame_.radiance[at] = traced.radiance;
        frame_.distance[at] = traced.distance;
        frame_.causes[at] = hole.cause;
        if (!origins_.empty()) origins_[at] = {PixelOrigin::Kind::traced, 1, 0};
        ++report.holes[static_cast<std::size_t>(hole.cause)];
    }
}

std::vector<std::uint8_t> CloudRegion::known() const {
    std::vector<std::uint8_t> known(frame_.radiance.size(), 1);
    for (std::size_t i = 0; i < holes_.size(); ++i)
        if (done_[i] == 0 && !holes_[i].guessed) known[pixel(holes_[i].place)] = 0;
    return known;
}

void CloudRegion::leave_points() {
    fresh_.clear();
    for (std::size_t i = 0; i < holes_.size(); ++i) {
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

void CloudRegion::keep(const AgeLimit& room) {
    const StepTimer timer(frame_.report.keep_seconds);
    const auto stays = [&](const CloudPoint& point) {
        return point.age < room.age ||
               (point.age == room.age && lot(point, rules_.frame) >= room.share);
    };
    if (room.age == 0) std::erase_if(fresh_, [&](const CloudPoint& p) { return !stays(p); });
    // New points take the places of those that go, and then the last ones do.
    std::size_t next = 0, end = points_.size();
    for (std::size_t i = 0; i < end;) {
        if (kept_[i] != 0 && stays(points_[i])) {
            ++i;
        } else if (next < fresh_.size()) {
            points_[i++] = fresh_[next++];
        } else {
            --end;
            points_[i] = points_[end];
            kept_[i] = kept_[end];
        }
    }
    points_.resize(end);
    points_.insert(points_.end(), fresh_.begin() + static_cast<std::ptrdiff_t>(next), fresh_.end());
    fresh_.clear();
    frame_.report.points = points_.size();
}

}  // namespace lightwalk
