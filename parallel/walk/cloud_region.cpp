#include "parallel/walk/cloud_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/cloud/answer_block.h"
#include "core/cloud/surface_fill.h"
#include "core/error.h"
#include "parallel/blocks.h"
#include "parallel/executor_task_runner.h"
#include "parallel/walk/step_timer.h"

namespace lightwalk {
namespace {

constexpr int kBlockSide = 64;  ///< of the pixels that a task answers
constexpr int kAwake = 8;       ///< frames for which points out of the picture do not sleep yet

}  // namespace

CloudRegion::CloudRegion(const PixelRectangle& area, int width, int height,
                         const CloudOptions& options, FrameClock clock)
    : options_(options),
      clock_(std::move(clock)),
      points_(area, width, height),
      blocks_(make_blocks(area, kBlockSide)),
      uncached_of_(blocks_.size()),
      to_trace_(options) {
    frame_.area = area;
    frame_.radiance.resize(area.pixels());
    frame_.distance.resize(area.pixels());
    frame_.causes.resize(area.pixels());
    frame_.known.resize(area.pixels());
    if (options.refine > 0) frame_.origins.resize(area.pixels());
    if (options.budget > 0) {
        frame_.surfaces.resize(area.pixels());
        frame_.patterns.resize(area.pixels());
    }
}

void CloudRegion::begin(const Camera& camera, const CloudRules& rules) {
    rules_ = rules;
    points_.begin(camera);
    to_trace_.begin();
    frame_.complete = false;
    frame_.report = {};
    frame_.report.pixels = frame_.area.pixels();
    frame_.report.tightness = rules.tightness;
}

void CloudRegion::project(Executor& executor) {
    const StepTimer timer(frame_.report.project_seconds, clock_);
    points_.project(ExecutorTaskRunner(executor));
}

void CloudRegion::add(std::span<const CloudPoint> points, std::span<const Rgb> groups) {
    const StepTimer timer(frame_.report.project_seconds, clock_);
    if (groups.size() != points.size() * options_.light_groups)
        throw InputError("points of a walk come with other light groups than are kept");
    points_.add(points, groups);
}

void CloudRegion::answer(PixelCaster& caster, Executor& executor, const StopFlag& stop,
                         Clock::time_point check_until) {
    const StepTimer timer(frame_.report.check_seconds, clock_);
    const auto is_late = [&] { return clock_.now() > check_until; };
    const RegionAnswers answers{options_, rules_, caster, is_late, to_trace_.finest_grid(),
                                points_,  frame_};
    // Where time is short it is that of the last ones: others in each frame.
    const std::size_t first = rules_.frame * (blocks_.size() / 3 + 1);
    executor.for_each(
        blocks_.size(),
        [&](std::size_t task, int worker) {
            const std::size_t block = (first + task) % blocks_.size();
            answer_block(answers, blocks_[block], worker, uncached_of_[block]);
        },
        stop);
    if (!stop.requested())
        to_trace_.gather(uncached_of_, rules_.frame, ExecutorTaskRunner(executor));
}

void CloudRegion::infer(PixelCaster& caster, Executor& executor, const StopFlag& stop,
                        Clock::time_point until) {
    CloudReport& report = frame_.report;
    if (frame_.surfaces.empty() || report.filled == report.inferred) return;
    const StepTimer timer(report.infer_seconds, clock_);
    std::vector<std::vector<InferredPixel>> inferred(blocks_.size());
    const std::size_t first = rules_.frame * (blocks_.size() / 3 + 1);
    executor.for_each(
        blocks_.size(),
        [&](std::size_t task, int worker) {
            if (clock_.now() > until) return;
            const std::size_t block = (first + task) % blocks_.size();
            infer_block(frame_, blocks_[block], caster, worker, inferred[block]);
        },
        stop);
    for (const std::vector<InferredPixel>& of_block : inferred) show_inferred(of_block, frame_);
}

void CloudRegion::refine(std::span<const PixelPlace> places) {
    std::fill(frame_.causes.begin(), frame_.causes.end(), TraceCause::none);
    to_trace_.refine(places);
}

namespace {

constexpr int kTileSide = 8;         ///< of pixels that are probed together
constexpr float kSamePlace = 0.01f;  ///< of what is known, as a share of the distance
/// From farther aside what is known does not hold: how fast highlights move is not asked for, as
/// that takes longer than all else [rad].
constexpr float kRecalledAngle = 0.1f;

/// Pixels that are probed together, and what is known of them.
struct KnownTile {
    std::vector<PixelPlace> places;
    std::vector<PixelValue> values;
};

void recall_tile(const KnownTile& tile, PixelCaster& caster, double tolerance, int worker,
                 std::vector<PixelPoints>& points) {
    std::array<PixelVisibility, std::size_t{kTileSide} * kTileSide> seen;
    caster.probe(tile.places, {}, std::span(seen).first(tile.places.size()), worker);
    for (std::size_t i = 0; i < tile.places.size(); ++i) {
        const PrimaryVisibility& ahead = seen[i].ahead;
        const PixelValue& value = tile.values[i];
        const bool same = seen[i].ray && ahead.seen && !seen[i].mirrored.seen &&
                          std::abs(ahead.distance - value.distance) <= kSamePlace * value.distance;
        if (!same) continue;
        points.push_back(points_of({seen[i], value.radiance, {}, value.distance}, tolerance));
        for (CloudPoint& point : points.back().points)
            point.max_view_angle = std::min(point.max_view_angle, kRecalledAngle);
    }
}

}  // namespace

void CloudRegion::recall(std::span<const PixelValue> known, PixelCaster& caster,
                         Executor& executor) {
    const auto width = static_cast<std::size_t>(points_.width());
    if (known.size() != width * static_cast<std::size_t>(points_.height()))
        throw InputError("a known picture of a walk is of another size than its frame");
    std::vector<std::vector<PixelPoints>> found(blocks_.size());
    executor.for_each(blocks_.size(), [&](std::size_t block, int worker) {
        for (const PixelRectangle& area : make_blocks(blocks_[block], kTileSide)) {
            KnownTile tile;
            for (int y = area.y0; y < area.y1; ++y)
                for (int x = area.x0; x < area.x1; ++x) {
                    const PixelValue& value =
                        known[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
                    if (!(value.distance > 0)) continue;
                    tile.places.push_back({x, y});
                    tile.values.push_back(value);
                }
            recall_tile(tile, caster, options_.tolerance, worker, found[block]);
        }
    });
    for (const std::vector<PixelPoints>& of_block : found)
        for (const PixelPoints& points : of_block) points_.leave(points);
}

AgeCounts CloudRegion::age(Executor& executor) {
    const StepTimer timer(frame_.report.keep_seconds, clock_);
    to_trace_.leave_points(points_);
    const int age = static_cast<int>(std::ceil(options_.age * rules_.tightness));
    // Where the eye looks back, what it has seen before is there again. Without a budget frames are
    // the same for any number of ranks, which sleep apart: then they forget.
    const int awake = options_.budget > 0 ? kAwake : 0;
    return points_.age({age, options_.supersaturated, awake}, ExecutorTaskRunner(executor));
}

AgeCounts CloudRegion::rest(bool leave) {
    if (leave) to_trace_.leave_points(points_);
    return points_.rest();
}

void CloudRegion::keep(const AgeLimit& room, Executor& executor) {
    const StepTimer timer(frame_.report.keep_seconds, clock_);
    points_.keep(room, rules_.frame, ExecutorTaskRunner(executor));
    frame_.report.points = points_.all().size();
}

}  // namespace lightwalk
