#include "parallel/walk/cloud_frames.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "core/cloud/gaps.h"
#include "core/math/random.h"
#include "parallel/blocks.h"

namespace lightwalk {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kPointsATask = 16384;
constexpr int kBlockSide = 64;  ///< of the pixels that a task answers
constexpr int kPacketSide = 8;  ///< of those that are looked at together
constexpr std::size_t kHolesATask = 32;

/// Of the audited pixels a second ray tells how much two rays differ.
constexpr double kFloorShare = 0.25;

std::size_t tasks_for(std::size_t count, std::size_t each) {
    return (count + each - 1) / each;
}

class StepTimer {
  public:
    explicit StepTimer(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
    ~StepTimer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
    StepTimer(const StepTimer&) = delete;
    StepTimer& operator=(const StepTimer&) = delete;

  private:
    double& seconds_;
    Clock::time_point start_;
};

/// Many pixels may use one point.
void mark(std::uint8_t& flag) {
    std::atomic_ref<std::uint8_t>(flag).store(1, std::memory_order_relaxed);
}

float relative_error(const Rgb& value, const Rgb& truth) {
    const float is = brightness(value), should = brightness(truth);
    return std::abs(is - should) / std::max(should, 1e-9f);
}

}  // namespace

/// A pixel that is to be traced.
struct CloudFrames::Hole {
    PixelPlace place;
    HoleCause cause = HoleCause::uncovered;
    bool guessed = false;  ///< it shows something meanwhile that is better than its neighbours
};

/// One frame on its way.
struct CloudFrames::Step {
    const Camera& camera;
    const PixelCaster& caster;
    Executor& executor;
    const StopFlag& stop;
    PointProjector projector;
    ReuseRules rules;
    Clock::time_point deadline = Clock::time_point::max();
    bool rests = false;  ///< the view is that of the frame before
    CloudFrame frame;
    std::vector<PixelOrigin> origins;  ///< of each pixel; empty unless views that rest are refined
    std::vector<Block> blocks;
    std::vector<std::vector<Hole>> holes_of;  ///< each block
    std::vector<Hole> holes;
    RestingWork work;                 ///< what the holes of a resting view are
    std::vector<TracedPixel> traced;  ///< each hole
    std::vector<std::uint8_t> done;   ///< for each hole: not 0 where it was traced in time

    Step(const Camera& view, const PixelCaster& rays, Executor& workers, const StopFlag& end,
         int width, int height)
        : camera(view),
          caster(rays),
          executor(workers),
          stop(end),
          projector(view, width, height),
          blocks(make_blocks({0, 0, width, height}, kBlockSide)),
          holes_of(blocks.size()) {
        const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        frame.radiance.resize(pixels);
        frame.distance.resize(pixels);
        frame.causes.resize(pixels, HoleCause::none);
        frame.report.pixels = pixels;
    }
};

CloudFrames::CloudFrames(int width, int height, const CloudOptions& options)
    : width_(width),
      height_(height),
      options_(options),
      grids_(width, height),
      guard_(options.audit_limit),
      resting_(width, height) {}

CloudFrame CloudFrames::draw(const Camera& camera, const PixelCaster& caster, Executor& executor,
                             const StopFlag& stop) {
    Step step(camera, caster, executor, stop, width_, height_);
    if (options_.budget > 0)
        step.deadline =
            Clock::now() + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(options_.budget - last_keep_seconds_));
    step.frame.report.tightness = guard_.tightness();
    step.rules = tightened(options_.rules, guard_.tightness());
    step.rests = view_ == camera.view();
    if (step.rests) {
        plan_refinement(step);
    } else {
        project(step);
        answer(step);
    }
    trace(step);
    if (stop.requested()) return std::move(step.frame);
    if (step.rests)
        refine(step);
    else
        show(step);
    keep(step);
    last_keep_seconds_ = step.frame.report.keep_seconds;
    ++frame_;
    step.frame.complete = true;
    return std::move(step.frame);
}

void CloudFrames::project(Step& step) {
    const StepTimer timer(step.frame.report.project_seconds);
    places_.resize(points_.size());
    used_.assign(points_.size(), 0);
    const std::size_t cells = grids_.ahead.size();
    step.executor.for_each(tasks_for(cells, kPointsATask), [&](std::size_t task, int) {
        const std::size_t first = task * kPointsATask;
        const std::size_t last = std::min(first + kPointsATask, cells);
        grids_.ahead.clear(first, last);
        grids_.mirrored.clear(first, last);
    });
    step.executor.for_each(tasks_for(points_.size(), kPointsATask), [&](std::size_t task, int) {
        const std::size_t first = task * kPointsATask;
        project_points(step.projector, points_, first,
                       std::min(first + kPointsATask, points_.size()), grids_, places_);
    });
}

/// What decides whether this frame's audit traces a pixel though it is reused, and whether twice.
RandomStream CloudFrames::audit_stream(const PixelPlace& place) const {
    return RandomStream::of_pixel(options_.seed + frame_ + 1, static_cast<std::uint32_t>(place.x),
                                  static_cast<std::uint32_t>(place.y), 0);
}

void CloudFrames::answer(Step& step) {
    const StepTimer timer(step.frame.report.check_seconds);
    if (options_.refine > 0) step.origins.resize(step.frame.radiance.size());
    step.executor.for_each(
        step.blocks.size(),
        [&](std::size_t block, int worker) { answer_block(step, block, worker); }, step.stop);
    order_holes(step);
}

/// Where time is short: the worst first, and among equals another block each frame.
void CloudFrames::order_holes(Step& step) {
    const std::size_t blocks = step.holes_of.size();
    const std::size_t first = options_.budget > 0 ? frame_ % blocks : 0;
    for (std::size_t k = 0; k < blocks; ++k) {
        const std::vector<Hole>& holes = step.holes_of[(first + k) % blocks];
        step.holes.insert(step.holes.end(), holes.begin(), holes.end());
    }
    if (options_.budget > 0)
        std::stable_sort(step.holes.begin(), step.holes.end(),
                         [](const Hole& a, const Hole& b) { return a.cause < b.cause; });
}

/// Show what a pixel's answer brings, or note that it is a hole.
void CloudFrames::settle(Step& step, const PixelPlace& place, const PointFinder& finder,
                         const PixelAnswer& answer, std::vector<Hole>& holes) {
    const std::size_t at = pixel(place);
    const bool reused = answer.found();
    const bool guessed = !reused && options_.budget > 0 && finder.is_guess(answer);
    if (reused || guessed) {
        step.frame.radiance[at] = finder.radiance(answer);
        step.frame.distance[at] = finder.distance(answer);
    }
    if (!reused) {
        holes.push_back({place, answer.cause, guessed});
        return;
    }
    for (const std::uint32_t index : {answer.ahead, answer.mirrored})
        if (index != kNoPoint) mark(used_[index]);
    if (!step.origins.empty()) {
        const std::uint32_t index = answer.ahead != kNoPoint ? answer.ahead : answer.mirrored;
        const int fresh = index != kNoPoint ? kOldestAge - points_[index].old : 0;
        step.origins[at] = {PixelOrigin::Kind::reused, 0, static_cast<std::uint32_t>(fresh)};
    }
    if (options_.audit > 0 && audit_stream(place).next() < options_.audit)
        holes.push_back({place, HoleCause::audited, true});
}

void CloudFrames::answer_block(Step& step, std::size_t block, int worker) {
    const PointFinder finder(step.projector, points_, grids_, places_, step.rules);
    const Block& area = step.blocks[block];
    std::vector<Hole>& holes = step.holes_of[block];
    constexpr std::size_t kPacket = std::size_t{kPacketSide} * kPacketSide;
    std::array<PixelPlace, kPacket> checked;
    std::array<PixelSights, kPacket> sights;
    for (int y0 = area.y0; y0 < area.y1; y0 += kPacketSide) {
        for (int x0 = area.x0; x0 < area.x1; x0 += kPacketSide) {
            std::size_t count = 0;
            for (int y = y0; y < std::min(y0 + kPacketSide, area.y1); ++y) {
                for (int x = x0; x < std::min(x0 + kPacketSide, area.x1); ++x) {
                    const PixelPlace place{x, y};
                    const bool check =
                        !points_.empty() &&
                        (options_.check == CloudCheck::all ||
                         (options_.check == CloudCheck::edges && finder.is_edge(place)));
                    if (check)
                        checked[count++] = place;
                    else
                        settle(step, place, finder, finder.unchecked(place), holes);
                }
            }
            if (count == 0) continue;
            step.caster.look({checked.data(), count}, {sights.data(), count}, worker);
            for (std::size_t i = 0; i < count; ++i) {
                if (sights[i].ray)
                    settle(step, checked[i], finder, finder.checked(checked[i], sights[i]), holes);
            }
        }
    }
}

/// The view stands still: nothing is missing, but there are better values than those that it shows.
void CloudFrames::plan_refinement(Step& step) {
    const StepTimer timer(step.frame.report.check_seconds);
    const auto most = static_cast<std::size_t>(
        std::ceil(options_.refine * static_cast<double>(step.frame.report.pixels)));
    step.work = resting_.next(most);
    for (const PixelPlace& place : step.work.places)
        step.holes.push_back({place, HoleCause::refined, true});
}

void CloudFrames::trace(Step& step) {
    const StepTimer timer(step.frame.report.trace_seconds);
    step.traced.resize(step.holes.size());
    step.done.assign(step.holes.size(), 0);
    trace_all(step, step.holes, step.work.sample, step.traced, step.done);
    if (step.rests || step.stop.requested()) return;
    std::vector<Hole> twice;
    std::vector<std::size_t> of;
    for (std::size_t i = 0; i < step.holes.size(); ++i) {
        if (step.holes[i].cause != HoleCause::audited || step.done[i] == 0) continue;
        RandomStream random = audit_stream(step.holes[i].place);
        (void)random.next();  // has decided that it is audited
        if (random.next() >= kFloorShare) continue;
        twice.push_back(step.holes[i]);
        of.push_back(i);
    }
    std::vector<TracedPixel> others(twice.size());
    std::vector<std::uint8_t> done(twice.size());
    trace_all(step, twice, 1, others, done);
    for (std::size_t i = 0; i < twice.size(); ++i) {
        if (done[i] == 0) continue;
        step.frame.report.audit_floors.push_back(
            relative_error(others[i].radiance, step.traced[of[i]].radiance));
    }
}

/// Trace holes until the frame's time is over; some at least, or a short budget would never end.
void CloudFrames::trace_all(Step& step, std::span<const Hole> holes, int sample,
                            std::span<TracedPixel> traced, std::span<std::uint8_t> done) {
    step.executor.for_each(
        tasks_for(holes.size(), kHolesATask),
        [&](std::size_t task, int worker) {
            if (task > 0 && Clock::now() > step.deadline) return;
            const std::size_t first = task * kHolesATask;
            const std::size_t count = std::min(kHolesATask, holes.size() - first);
            std::array<PixelPlace, kHolesATask> places;
            for (std::size_t i = 0; i < count; ++i) places[i] = holes[first + i].place;
            step.caster.trace({places.data(), count}, traced.subspan(first, count), sample, worker);
            std::fill_n(done.begin() + static_cast<std::ptrdiff_t>(first), count, std::uint8_t{1});
        },
        step.stop);
}

/// Put what was traced into the picture.
void CloudFrames::show(Step& step) {
    CloudFrame& frame = step.frame;
    CloudReport& report = frame.report;
    report.reused = report.pixels;
    for (std::size_t i = 0; i < step.holes.size(); ++i) {
        const Hole& hole = step.holes[i];
        const bool audited = hole.cause == HoleCause::audited;
        const std::size_t at = pixel(hole.place);
        if (!audited) {
            --report.reused;
            frame.causes[at] = hole.cause;
        }
        if (step.done[i] == 0) {
            if (!audited) ++report.filled;
            continue;
        }
        const TracedPixel& traced = step.traced[i];
        if (audited)
            report.audit_errors.push_back(relative_error(frame.radiance[at], traced.radiance));
        frame.radiance[at] = traced.radiance;
        frame.distance[at] = traced.distance;
        frame.causes[at] = hole.cause;
        if (!step.origins.empty()) step.origins[at] = {PixelOrigin::Kind::traced, 1, 0};
        ++report.holes[static_cast<std::size_t>(hole.cause)];
    }
    guard_.take(report.audit_errors, report.audit_floors);
    if (report.filled > 0) fill(step);
    remember(step);
}

/// Holes that there was no time for, from what lies around them.
void CloudFrames::fill(Step& step) {
    std::vector<std::uint8_t> known(step.frame.radiance.size(), 1);
    for (std::size_t i = 0; i < step.holes.size(); ++i)
        if (step.done[i] == 0 && !step.holes[i].guessed) known[pixel(step.holes[i].place)] = 0;
    fill_gaps(width_, height_, step.frame.radiance, known);
}

/// For the case that the next frame has the same view.
void CloudFrames::remember(Step& step) {
    if (!(options_.refine > 0)) return;
    view_ = step.camera.view();
    resting_.begin(step.frame.radiance, step.origins);
    distance_ = step.frame.distance;
}

/// Put what was traced into the picture of a resting view.
void CloudFrames::refine(Step& step) {
    CloudFrame& frame = step.frame;
    RestingWork done{step.work.sample, {}};
    std::vector<Rgb> radiance;
    for (std::size_t i = 0; i < step.holes.size(); ++i) {
        if (step.done[i] == 0) continue;
        const PixelPlace& place = step.holes[i].place;
        done.places.push_back(place);
        radiance.push_back(step.traced[i].radiance);
        frame.causes[pixel(place)] = HoleCause::refined;
        if (step.work.sample == 0) distance_[pixel(place)] = step.traced[i].distance;
    }
    resting_.take(done, radiance);
    frame.radiance.assign(resting_.radiance().begin(), resting_.radiance().end());
    frame.distance = distance_;
    frame.report.holes[static_cast<std::size_t>(HoleCause::refined)] = radiance.size();
    const auto filled = std::count_if(
        resting_.origins().begin(), resting_.origins().end(),
        [](const PixelOrigin& pixel) { return pixel.kind == PixelOrigin::Kind::filled; });
    frame.report.filled = static_cast<std::size_t>(filled);
    frame.report.reused = frame.report.pixels - frame.report.filled;
}

/// Points grow older, but for those of a view that rests. Sets `kept_`.
AgeCounts CloudFrames::age(Step& step) {
    kept_.resize(points_.size());
    AgeCounts all{};
    if (step.rests) {
        for (std::size_t i = 0; i < points_.size(); ++i) {
            kept_[i] = points_[i].kind == PointKind::gone ? 0 : 1;
            all[points_[i].age] += kept_[i];
        }
        return all;
    }
    const int age = static_cast<int>(std::ceil(options_.age * guard_.tightness()));
    const CloudLife life{age, options_.supersaturated};
    const std::size_t tasks = tasks_for(points_.size(), kPointsATask);
    std::vector<AgeCounts> counts(tasks);
    const auto part = [&](std::size_t task, auto& whole) {
        const std::size_t first = task * kPointsATask;
        return std::span(whole).subspan(first, std::min(kPointsATask, whole.size() - first));
    };
    step.executor.for_each(tasks, [&](std::size_t task, int) {
        counts[task] = age_points(part(task, points_), part(task, used_), part(task, places_), life,
                                  part(task, kept_));
    });
    for (const AgeCounts& one : counts)
        for (std::size_t i = 0; i < all.size(); ++i) all[i] += one[i];
    return all;
}

/// What was traced leaves points, in the places of those that are gone. A resting view's further
/// rays leave none: one a pixel is enough.
void CloudFrames::keep(Step& step) {
    const StepTimer timer(step.frame.report.keep_seconds);
    const auto most = static_cast<std::size_t>(options_.limit * static_cast<double>(width_) *
                                               static_cast<double>(height_));
    std::vector<CloudPoint> fresh;
    for (std::size_t i = 0; i < step.traced.size() && step.work.sample == 0; ++i) {
        if (step.done[i] == 0) continue;
        const PixelPoints left = points_of(step.traced[i], options_.tolerance);
        fresh.insert(fresh.end(), left.points.begin(),
                     left.points.begin() + static_cast<std::ptrdiff_t>(left.count));
    }
    if (fresh.size() > most) fresh.resize(most);
    AgeLimit room = age_limit(age(step), most - fresh.size());
    std::size_t next = 0, count = fresh.size();
    for (std::size_t i = 0; i < points_.size(); ++i) {
        CloudPoint& point = points_[i];
        bool stays = kept_[i] != 0 && point.age <= room.age;
        if (stays && point.age == room.age && room.at_limit > 0) {
            --room.at_limit;
            stays = false;
        }
        if (stays)
            ++count;
        else if (next < fresh.size())
            point = fresh[next++];
        else
            point.kind = PointKind::gone;
    }
    points_.insert(points_.end(), fresh.begin() + static_cast<std::ptrdiff_t>(next), fresh.end());
    step.frame.report.points = count;
}

}  // namespace lightwalk
