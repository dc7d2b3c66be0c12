// Frames of a walk drawn by ranks that are threads, over a wire that delays and reorders.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "core/light/find_light_groups.h"
#include "parallel/ranks/assembly.h"
#include "parallel/ranks/rank_frame_exchange.h"
#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/frame_lead.h"
#include "parallel/walk/scene_caster.h"
#include "tests/parallel/ranks/memory_ranks.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic tiles 0 0 5 .4 .4 .5 .06 0
void plastic satin 0 0 5 .3 .5 .3 .04 .1
void mirror silver 0 0 3 .9 .9 .9
void glass pane 0 0 3 .9 .9 .9
void light lamp 0 0 3 40 40 40
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
grey polygon left 0 0 12  -4 -6 0  -4 6 0  -4 6 3  -4 -6 3
tiles polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
silver polygon mirror 0 0 12  -2 5.99 .5  1 5.99 .5  1 5.99 2.5  -2 5.99 2.5
pane polygon window 0 0 12  1.5 3 0  3.5 3 0  3.5 3 2.5  1.5 3 2.5
satin sphere ball 0 0 4 -1.5 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";

constexpr int kWidth = 61, kHeight = 47;

struct Step {
    View view;
    int width = kWidth, height = kHeight;  ///< of its frame
    LightMixture mixture = {};             ///< of a lit room's light groups
};

FrameOptions frame_options(const Step& step) {
    FrameOptions options;
    options.width = step.width;
    options.height = step.height;
    options.pixels.spacing = 1;
    return options;
}

/// Forward, aside and round about: points cross all borders.
std::vector<Step> walk(int frames) {
    std::vector<Step> steps(static_cast<std::size_t>(frames));
    for (int i = 0; i < frames; ++i) {
        View& view = steps[static_cast<std::size_t>(i)].view;
        view.position = {0.04 * i, -4 + 0.05 * i, 1.5};
        view.direction = {std::sin(0.03 * i), std::cos(0.03 * i), -0.05 + 0.01 * i};
        view.horizontal = 60;
        view.vertical = 46.8;
    }
    return steps;
}

/// Packets arrive late, and in another order, but for those of one sender. With odd seeds every
/// rank has a machine of its own.
class DelayingCommunicator final : public Communicator {
  public:
    DelayingCommunicator(std::unique_ptr<Communicator> wire, std::uint64_t seed)
        : wire_(std::move(wire)), one_machine_(seed % 2 == 0), random_(seed) {}
    [[nodiscard]] int rank() const override { return wire_->rank(); }
    [[nodiscard]] int size() const override { return wire_->size(); }
    [[nodiscard]] std::string host() const override { return wire_->host(); }
    [[nodiscard]] bool on_one_machine() const override { return one_machine_; }
    void send(int to, std::string bytes) override { wire_->send(to, std::move(bytes)); }
    [[nodiscard]] std::optional<Packet> receive() override {
        while (std::optional<Packet> packet = wire_->receive())
            held_[packet->from].push_back(std::move(*packet));
        std::erase_if(held_, [](const auto& entry) { return entry.second.empty(); });
        if (held_.empty() || random_() % 3 == 0) return std::nullopt;
        auto sender = held_.begin();
        std::advance(sender, static_cast<std::ptrdiff_t>(random_() % held_.size()));
        Packet packet = std::move(sender->second.front());
        sender->second.pop_front();
        return packet;
    }
    void wait(std::chrono::microseconds) override { wire_->wait(std::chrono::microseconds{50}); }
    void wake() override { wire_->wake(); }
    [[nodiscard]] std::string broadcast(std::string bytes) override {
        return wire_->broadcast(std::move(bytes));
    }
    void flush() override { wire_->flush(); }
    [[noreturn]] void abort(int status) override {
        wire_->abort(status);
        std::terminate();
    }

  private:
    std::unique_ptr<Communicator> wire_;
    bool one_machine_;
    std::mt19937_64 random_;
    std::map<int, std::deque<Packet>> held_;  ///< by sender
};

struct Room {
    /// @param more  lights; then their groups are kept, too
    explicit Room(const std::string& more = "") : scene(kRoom + more) {
        if (!more.empty())
            groups = std::make_shared<const LightGroups>(
                find_light_groups(scene.scene, scene.tracer.options(), {}));
    }
    [[nodiscard]] std::unique_ptr<WorkerContexts> contexts(int workers) {
        auto made = std::make_unique<WorkerContexts>(scene.tracer, scene.warnings, workers);
        if (groups) made->sum_by(groups);
        return made;
    }
    TestScene scene;
    std::shared_ptr<const LightGroups> groups;
    VisibilityProbe visibility{scene.tracer};
    StopFlag stop;
};

const std::string kSky = "void glow sky 0 0 4 5 6 8 0\nsky source up 0 0 4 0 0 1 360\n";

std::unique_ptr<SceneCaster> rays_of(Room& room, const Step& step, WorkerContexts& contexts) {
    return std::make_unique<SceneCaster>(room.scene.tracer, room.visibility, Camera(step.view),
                                         frame_options(step), contexts, room.stop,
                                         FrameUse::picture, &step.mixture);
}

/// What a frame of a walk shows, and what it took.
struct Drawn {
    std::vector<PixelValue> values;  ///< row by row from the bottom
    CloudReport report;
};

Drawn to_drawn(const CloudFrame& frame) {
    Drawn drawn;
    drawn.report = frame.report;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i)
        drawn.values.push_back({frame.radiance[i], frame.distance[i]});
    return drawn;
}

std::vector<Drawn> draw_alone(Room& room, const std::vector<Step>& steps,
                              const CloudOptions& options) {
    const auto executor = make_executor(ExecutorKind::serial, 1);
    const auto contexts = room.contexts(1);
    CloudFrames frames(kWidth, kHeight, options);
    std::vector<Drawn> result;
    LightMixture mixture;
    for (const Step& step : steps) {
        frames.resize(step.width, step.height);
        if (step.mixture != mixture) (void)frames.mix(mixture = step.mixture);
        const auto rays = rays_of(room, step, *contexts);
        result.push_back(to_drawn(frames.draw(rays->camera(), *rays, *executor, room.stop)));
    }
    return result;
}

struct Company {
    Variant variant = Variant::hybrid;
    int ranks = 3, threads = 1, projectors = 32;
};

/// The program of rank 0.
std::vector<Drawn> lead(RankLink& link, const std::vector<Step>& steps,
                        const CloudOptions& options) {
    const auto executor = make_executor(ExecutorKind::serial, 1);
    const StopFlag never;
    const auto finished = [&](FrameOrder order) {
        order.number = link.new_number();
        link.start({order});
        for (;;)
            for (const ProgramNews& news : link.take_news(true, never))
                if (const auto* frame = std::get_if<FinishedFrame>(&news))
                    return assemble_frame(order, *frame);
    };
    std::vector<Drawn> result;
    FrameLead walk(kWidth, kHeight, options, 0);
    CloudFrame last;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::string payload = std::to_string(i);
        walk.resize(steps[i].width, steps[i].height);
        if (i > 0 && steps[i].mixture != steps[i - 1].mixture && !walk.mix(steps[i].mixture))
            walk.abandon();
        if (walk.rests(steps[i].view) && walk.wants_origins())
            walk.begin_progressive(last, finished(walk.origins_order(payload)).frame.origins);
        AssembledFrame drawn = finished(walk.order(steps[i].view, payload));
        walk.complete(drawn.frame, drawn.refined, *executor, drawn.refined_groups);
        last = std::move(drawn.frame);
        result.push_back(to_drawn(last));
    }
    return result;
}

std::vector<Drawn> draw_together(Room& room, const std::vector<Step>& steps,
                                 const CloudOptions& options, const Company& company,
                                 std::uint64_t seed) {
    Wires wires = make_memory_communicators(company.ranks);
    for (std::size_t rank = 0; rank < wires.size(); ++rank)
        wires[rank] = std::make_unique<DelayingCommunicator>(std::move(wires[rank]),
                                                             2 * (seed * 1000 + rank) + seed % 2);
    RankSettings settings;
    settings.slots = company.threads;
    settings.projectors = company.projectors;
    std::vector<Drawn> result;
    const auto draw = [&](RankLink& link) {
        const auto contexts = room.contexts(company.threads);
        const auto make = [&](const FrameOrder& order) {
            return rays_of(room, steps.at(static_cast<std::size_t>(std::stoi(order.payload))),
                           *contexts);
        };
        std::thread program;
        if (link.leads()) {
            program = std::thread([&] {
                result = lead(link, steps, options);
                link.dismiss();
            });
        }
        const auto executor = make_executor(ExecutorKind::threads, company.threads);
        if (link.traces())
            draw_frames(link, options, make, *executor, room.stop);
        else
            link.inbox().wait_for_end(room.stop);
        if (program.joinable()) program.join();
        link.end_work();
    };
    CHECK(all_well(run_ranks(make_topology(company.variant, company.ranks, false, 1), settings,
                             draw, std::move(wires))));
    return result;
}

void check_same(const std::vector<Drawn>& alone, const std::vector<Drawn>& together) {
    REQUIRE(alone.size() == together.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CAPTURE(i);
        CHECK(together[i].values == alone[i].values);
        const CloudReport &a = alone[i].report, &b = together[i].report;
        CHECK(b.reused == a.reused);
        CHECK(b.uncached == a.uncached);
        CHECK(b.points == a.points);
        CHECK(b.tightness == a.tightness);
        CHECK(quantile(b.audit_errors, 0.5) == quantile(a.audit_errors, 0.5));
        CHECK(quantile(b.audit_floors, 0.9) == quantile(a.audit_floors, 0.9));
    }
}

}  // namespace

TEST_CASE("ranks draw the frames of a walk that one process does, whatever the wire does") {
    Room room;
    const std::vector<Step> steps = walk(5);
    CloudOptions options;
    options.audit = 0.2;
    options.audit_limit = 0.001;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    CHECK(alone.back().report.reused > alone.back().report.pixels / 2);
    std::uint64_t seed = 1;
    for (const Company& company :
         {Company{Variant::hybrid, 1, 2}, Company{Variant::hybrid, 2, 1},
          Company{Variant::ranks, 3}, Company{Variant::ranks, 7}, Company{Variant::hybrid, 3, 2}}) {
        CAPTURE(company.ranks);
        check_same(alone, draw_together(room, steps, options, company, ++seed));
    }
}

TEST_CASE(
    "ranks draw frames of another size from the points of those before, as one process does") {
    Room room;
    std::vector<Step> steps = walk(5);
    for (const std::size_t small : {2, 3}) {
        steps[small].width = kWidth / 2;
        steps[small].height = kHeight / 2;
    }
    const CloudOptions options;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    CHECK(alone[2].report.reused > alone[2].report.pixels / 2);
    CHECK(alone[4].report.reused > alone[4].report.pixels / 4);
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3}, 8));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 4}, 9));
}

TEST_CASE("a walk is the same where only some ranks keep points, and where most own nothing") {
    Room room;
    const std::vector<Step> steps = walk(4);
    const CloudOptions options;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    check_same(alone,
               draw_together(room, steps, options, {Variant::hybrid, 5, 1, /*projectors=*/2}, 3));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 4, 1, 1}, 4));
}

TEST_CASE("a walk by ranks is the same in every mode") {
    Room room;
    const std::vector<Step> steps = walk(4);
    for (const CloudCheck check : {CloudCheck::rotating, CloudCheck::edges, CloudCheck::none}) {
        CloudOptions options;
        options.check = check;
        options.supersaturated = check == CloudCheck::none;
        options.rules.look_back = check != CloudCheck::none;
        check_same(draw_alone(room, steps, options),
                   draw_together(room, steps, options, {Variant::hybrid, 4}, 5));
    }
}

TEST_CASE("a walk by ranks keeps no more points than one process does for want of room") {
    Room room;
    const std::vector<Step> steps = walk(8);
    CloudOptions options;
    options.limit = 1.4;
    options.audit = 0.5;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    const std::vector<Drawn> together =
        draw_together(room, steps, options, {Variant::hybrid, 3}, 6);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CHECK(together[i].values == alone[i].values);
        CHECK(alone[i].report.points <= options.most_points(kWidth, kHeight));
    }
}

TEST_CASE("a walk by ranks with a budget misses no pixel") {
    Room room;
    const std::vector<Step> steps = walk(3);
    CloudOptions options;
    options.budget = 1e-9;
    for (const Drawn& drawn : draw_together(room, steps, options, {Variant::hybrid, 3, 2}, 7)) {
        const CloudReport& report = drawn.report;
        std::size_t traced = 0;
        for (const std::size_t count : report.uncached) traced += count;
        CHECK(report.pixels == drawn.values.size());
        CHECK(report.reused + report.filled + traced == report.pixels);
        CHECK(traced > 0);
        CHECK(report.filled > 0);
        for (const PixelValue& value : drawn.values) CHECK(value.distance >= 0);
    }
}

TEST_CASE("a walk by ranks is dimmed as one process's is, in motion and at rest") {
    Room room(kSky);
    REQUIRE(room.groups->size() == 2);
    std::vector<Step> steps = walk(5);
    steps.insert(steps.end(), 9, steps.back());  // at rest, until each pixel is traced, and on
    const LightMixture evening{{{1.5F, 1, .4F}, {.1F, .1F, .2F}}}, night{{{.2F, .1F, .1F}, {}}};
    for (const std::size_t i : {2, 3, 4, 5, 6, 7, 8, 9}) steps[i].mixture = evening;
    for (const std::size_t i : {10, 11, 12, 13}) steps[i].mixture = night;
    CloudOptions options;
    options.refine = 0.4;
    options.limit = 9;  // there is room for all points
    SUBCASE("as pictures") {}
    SUBCASE("as what is seen for a moment only, and traced again at rest") {
        options.budget = 1000;
    }
    options.light_groups = room.groups->size();
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    for (const std::size_t i : {3, 11})  // most is from points, and from pixels at rest
        CHECK(alone[i].report.reused > alone[i].report.pixels / 2);
    const auto blue = [](const Drawn& drawn) {
        double sum = 0;
        for (const PixelValue& value : drawn.values) sum += static_cast<double>(value.radiance.b);
        return sum;
    };
    CHECK(blue(alone[4]) < .5 * blue(draw_alone(room, walk(5), options)[4]));
    CHECK(blue(alone[10]) < .3 * blue(alone[9]));
    const auto refined = static_cast<std::size_t>(TraceCause::refined);
    if (options.budget > 0) CHECK(alone[10].report.uncached[refined] > 0);  // it goes on
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3}, 10));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 5}, 11));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 4, 1, 1}, 12));
}

TEST_CASE("a walk by ranks whose view stands still becomes ever better, as by one process") {
    Room room;
    std::vector<Step> steps = walk(3);
    steps.insert(steps.end(), 4, steps.back());
    steps.push_back(walk(4).back());
    CloudOptions options;
    options.refine = 0.4;
    options.audit = 0.1;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    CHECK(alone[6].report.uncached[static_cast<std::size_t>(TraceCause::refined)] > 0);
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3}, 8));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 5}, 9));
}
