#include "tests/simulation/walk_run.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "apps/session/picture_order.h"
#include "core/error.h"
#include "tests/simulation/world_executor.h"

namespace lightwalk::simulation {
namespace {

constexpr int kNobody = -1;

/// What a change of the scene says, to those who prepare it.
struct RoomChange {
    std::uint32_t light = 0, screen = 0;
    int refused_by = kNobody;
};
template <class Wire>
void visit_fields(Wire& wire, RoomChange& change) {
    wire(change.light, change.screen, change.refused_by);
}

ShownMaterials screen_alone() {
    std::vector<std::uint8_t> flags(kPointKinds * (std::size_t{kMaterialBits} + 1));
    flags[static_cast<std::size_t>(PointKind::plain) * (kMaterialBits + 1) + kScreen] = 1;
    return ShownMaterials(flags);
}

FrameOptions empty_options() {
    FrameOptions options;
    options.pixels.spacing = 1;
    return options;
}

}  // namespace

std::string description_of(const WalkPlan& plan) {
    std::ostringstream text;
    text << plan.projectors << " projectors, budget " << plan.cloud.budget << " s, "
         << plan.cloud.samples << " samples" << (plan.apart ? ", apart" : "")
         << (plan.groups ? ", groups" : "");
    return description_of(plan, text.str());
}

WalkRun::WalkRun(Fibers& fibers, const WalkPlan& plan, const Planted& planted, WalkStage& stage,
                 WalkProgress& progress, std::uint64_t seed)
    : RankRun(fibers, plan, planted, seed),
      plan_(plan),
      stage_(stage),
      progress_(progress),
      first_step_(progress.at),
      scenes_(static_cast<std::size_t>(plan.ranks), Scene{progress.steps[progress.at].room, {}}),
      serial_(make_executor(ExecutorKind::serial, 1)) {}

void WalkRun::lead(RankLink& link) {
    begin(link, progress_.steps[progress_.at]);
    while (!all_drawn() && take_step(link, progress_.steps[progress_.at])) ++progress_.at;
}

void WalkRun::begin(RankLink& link, const WalkStep& first) {
    frames_ = std::make_unique<RankFrames>(
        [&](FrameOrder order, const StopFlag&) { return draw(link, std::move(order)); },
        stage_.scene.tracer, nullptr, plan_.cloud, empty_options(), *serial_,
        stage_.scene.warnings);
    if (plan_.groups) frames_->keep_groups(stage_.groups);
    frames_->begin(first.width, first.height, false);
    CloudOptions cloud = plan_.cloud;
    if (plan_.groups) cloud.light_groups = kRoomGroups;
    alone_ = std::make_unique<CloudFrames>(first.width, first.height, cloud);
}

bool WalkRun::take_step(RankLink& link, const WalkStep& step) {
    if (frames_->options().width != step.width || frames_->options().height != step.height) {
        frames_->resize(step.width, step.height);
        alone_->resize(step.width, step.height);
    }
    if (plan_.groups) {
        (void)frames_->mix(step.mixture);
        (void)alone_->mix(step.mixture);
    }
    if (step.refused && !change_room(link, step, true)) return false;
    if (step.room != scenes_[0].room && !change_room(link, step, false)) return false;
    if (!show(step)) return false;
    if (step.looks_aside && has_budget() && !look_aside(step)) return false;
    return !step.settles || settle(step);
}

// As RankBackend::draw.
std::optional<AssembledFrame> WalkRun::draw(RankLink& link, FrameOrder order) {
    order.number = ordered_ = link.new_number();
    order.apart = plan_.apart && link.owners().size() == link.topology().workers.size();
    finished_.reset();
    link.start({order});
    while (!finished_) {
        if (stop_of(0).requested()) return std::nullopt;
        take_some(link);
    }
    traced_.erase(traced_.begin(), traced_.upper_bound(order.number));
    return assemble_frame(order, *finished_);
}

// As RankBackend::change_model.
bool WalkRun::change_room(RankLink& link, const WalkStep& step, bool refused) {
    const std::vector<int> workers = topology_.worker_ranks();
    ChangeOrder order;
    order.number = ordered_ = link.new_number();
    order.payload = wire::encode(RoomChange{step.room.light + (refused ? 1 : 0), step.room.screen,
                                            refused ? workers.back() : kNobody});
    if (step.keeps_some) order.shown = screen_alone().flags();
    prepared_.clear();
    link.start({order});
    order.payload.clear();
    while (prepared_.size() < workers.size()) {
        if (stop_of(0).requested()) return false;
        take_some(link);
    }
    const bool possible = std::ranges::all_of(
        prepared_, [](const auto& said) { return said.second.problem.empty(); });
    if (possible == refused) complain("a change is not refused by who cannot prepare it");
    if (possible) take_room(step);
    order.step = possible ? ChangeOrder::Step::take : ChangeOrder::Step::drop;
    link.start({order});
    return true;
}

void WalkRun::take_room(const WalkStep& step) {
    scenes_[0].room = step.room;
    if (step.keeps_some) frames_->outdate_only(screen_alone());
    frames_->set_kept(1);
    frames_->change(stage_.scene.tracer, nullptr, plan_.groups ? stage_.groups : nullptr,
                    stage_.scene.warnings);
    if (step.keeps_some) {
        (void)alone_->drop(screen_alone());
        return;
    }
    CloudOptions cloud = plan_.cloud;
    if (plan_.groups) cloud.light_groups = kRoomGroups;
    alone_ = std::make_unique<CloudFrames>(step.width, step.height, cloud);
    if (plan_.groups) (void)alone_->mix(step.mixture);
}

bool WalkRun::look_aside(const WalkStep& step) {
    View view = step.view;
    view.direction = {view.direction.y, -view.direction.x, view.direction.z};
    (void)frames_->progressive(stop_of(0));
    if (stop_of(0).requested()) return false;
    const auto unknown =
        frames_->look_aside(view, std::max(step.width / 2, 1), std::max(step.height / 2, 1),
                            plan_.cloud.budget, stop_of(0));
    return unknown.has_value();
}

bool WalkRun::show(const WalkStep& step) {
    WalkFrame drawn = frames_->draw(step.view, plan_.cloud.budget, plan_.cloud.refine, stop_of(0));
    if (!drawn.frame.complete) return false;
    check(step, drawn);
    shown_ = std::move(drawn.frame);
    return true;
}

/// Until nothing is left to be traced.
bool WalkRun::settle(const WalkStep& step) {
    constexpr int kMost = 100;
    for (int i = 0; i < kMost; ++i) {
        const ProgressivePicture* const picture = frames_->progressive(stop_of(0));
        if (stop_of(0).requested()) return false;
        if (picture == nullptr) {
            complain("a view that rests is not known");
            return true;
        }
        if (picture->finished()) {
            check_settled(step, shown_);
            return true;
        }
        if (!show(step)) return false;
    }
    complain("a view that rests is never done");
    return true;
}

/// Whether a frame can be one of this view and scene.
void WalkRun::check(const WalkStep& step, const WalkFrame& shown) {
    constexpr float kFarthest = 13;
    const std::size_t pixels = PixelRectangle{0, 0, step.width, step.height}.pixels();
    const Frame& frame = shown.frame;
    if (frame.width != step.width || frame.height != step.height ||
        frame.radiance.size() != pixels || frame.distance.size() != pixels)
        return complain("a frame has another size");
    std::size_t told = shown.report.reused + shown.report.filled;
    const auto& causes = shown.report.uncached;
    for (std::size_t cause = 0; cause < causes.size(); ++cause)
        if (cause != static_cast<std::size_t>(TraceCause::audited) &&
            cause != static_cast<std::size_t>(TraceCause::refined))
            told += causes[cause];
    if (shown.report.pixels != pixels || told != pixels)
        complain("a frame's pixels are not each told of once");
    // Levels of groups are a quarter at least.
    const float least = 2 * kDarkest / 4.1f * scale_of(step.room),
                most = 2.02f * kBrightest * scale_of(step.room);
    for (std::size_t i = 0; i < pixels; ++i) {
        const Rgb& seen = frame.radiance[i];
        if (!(min_component(seen) >= least) || !(max_component(seen) <= most))
            complain("a pixel is of another scene");
        if (!(frame.distance[i] >= 0) || frame.distance[i] > kFarthest)
            complain("a pixel is of no scene");
    }
    if (!has_budget()) check_with_one(step, shown);
}

/// Without a budget one process draws the same.
void WalkRun::check_with_one(const WalkStep& step, const WalkFrame& shown) {
    RoomCaster caster(step.room, picture_of(step, FrameUse::picture), 1);
    const StopFlag never;
    const CloudFrame& drawn = alone_->draw(caster.camera(), caster, *serial_, never);
    const Frame frame = turned_over(drawn, *serial_);
    std::size_t others = 0;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i)
        others += frame.radiance[i] != shown.frame.radiance[i] ||
                          frame.distance[i] != shown.frame.distance[i]
                      ? 1
                      : 0;
    if (others > 0)
        complain("a frame is another one than that of one process: step " +
                 std::to_string(progress_.at) + ", " + std::to_string(others) + " pixels of " +
                 std::to_string(step.width) + " x " + std::to_string(step.height));
    if (drawn.report.reused != shown.report.reused ||
        drawn.report.uncached != shown.report.uncached)
        complain("a frame takes something else than that of one process");
}

/// A view that has rested for long enough is what its own rays show, whatever was before.
void WalkRun::check_settled(const WalkStep& step, const Frame& shown) {
    if (plan_.cloud.samples > 1) return;
    const FrameUse use = use_of_frame(plan_.cloud.budget, true);
    RoomCaster caster(step.room, picture_of(step, use), 1);
    const UncachedPixelTracer tracer(caster, plan_.cloud.tolerance,
                                     UncachedPixelTracer::Clock::time_point::max());
    std::vector<PixelPlace> places;
    for (int y = step.height - 1; y >= 0; --y)
        for (int x = 0; x < step.width; ++x) places.push_back({x, y});
    tracer.trace_part(places, 0, 0, true, [&](std::size_t first, const TracedPixels& traced) {
        for (std::size_t i = 0; i < traced.results.size(); ++i) {
            const PixelValue is{shown.radiance[first + i], shown.distance[first + i]};
            if (is != traced.results[i].value)
                complain("a pixel at rest is not what its ray shows");
        }
    });
}

void WalkRun::take(ProgramNews news) {
    if (auto* finished = std::get_if<FinishedFrame>(&news)) {
        if (finished_ || finished->frame != ordered_) complain("a frame that nobody ordered");
        finished_ = std::move(*finished);
    } else if (const auto* told = std::get_if<RankNotice>(&news)) {
        const auto* said = std::get_if<PreparedChange>(&told->notice.notice);
        if (said == nullptr || said->number != ordered_ ||
            !prepared_.emplace(told->from, *said).second)
            complain("a rank says something that it was not asked for");
    }
}

void WalkRun::trace(RankLink& link) {
    CloudOptions cloud = plan_.cloud;
    if (plan_.groups) cloud.light_groups = kRoomGroups;
    const StopFlag& stop = stop_of(link.rank());
    if (plan_.slots == 1) return draw_frames(link, cloud, scene_of(link.rank()), *serial_, stop);
    WorldExecutor executor(world_);
    draw_frames(link, cloud, scene_of(link.rank()), executor, stop);
}

// As RankBackend::walk_scene: on rank 0 the program takes the scene.
WalkScene WalkRun::scene_of(int rank) {
    Scene& own = scenes_[static_cast<std::size_t>(rank)];
    WalkScene scene;
    scene.make_rays = [this, rank](const FrameOrder& order) { return make_rays(rank, order); };
    scene.prepare = [this, rank, &own](const std::string& payload) {
        const auto change = wire::decode<RoomChange>(payload);
        world_.sleep(world_.chance().up_to(plan_.longest_work));
        if (change.refused_by == rank) throw InputError("it cannot be");
        if (own.prepared) complain("a scene is prepared beside another one");
        if (rank != 0) own.prepared = WalkRoom{change.light, change.screen};
    };
    scene.take = [this, rank, &own](FrameNumber) {
        if (rank != 0 && !own.prepared) complain("a scene is taken that was not prepared");
        if (rank != 0) own.room = std::exchange(own.prepared, {}).value_or(own.room);
        return plan_.groups ? kRoomGroups : 0;
    };
    scene.drop = [&own] { own.prepared.reset(); };
    return scene;
}

std::unique_ptr<FrameCaster> WalkRun::make_rays(int rank, const FrameOrder& order) {
    const RoomCaster::Picture picture{
        wire::decode<PictureOrder>(order.payload).view, order.width,   order.height,
        use_of_frame(order.budget, order.rests),        order.mixture, plan_.groups};
    RoomCaster::Watch watch;
    if (order.budget > 0)
        watch.looks = [this] { world_.sleep(world_.chance().up_to(plan_.longest_work / 8)); };
    watch.traces = [this, rank, &order](std::span<const PixelPlace> places, int sample) {
        work_a_while(rank);
        note_traced(order, places, sample);
    };
    return std::make_unique<RoomCaster>(scenes_[static_cast<std::size_t>(rank)].room, picture,
                                        plan_.slots, std::move(watch));
}

void WalkRun::note_traced(const FrameOrder& order, std::span<const PixelPlace> places, int sample) {
    const PixelRectangle whole{0, 0, order.width, order.height};
    std::vector<std::uint8_t>& traced = traced_[order.number];
    traced.resize(2 * whole.pixels());  // noise pairs are traced by another sample
    for (const PixelPlace& place : places) {
        const std::size_t at = whole.index(place) + (sample == order.sample ? 0 : whole.pixels());
        if (++traced[at] > 1) complain("a pixel is traced twice");
    }
    if (order.number < ordered_) complain("a frame is traced that is over");
}

}  // namespace lightwalk::simulation
