// Walks on ranks that fail: thousands of stories.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <variant>

#include "parallel/fibers/context_fibers.h"
#include "tests/one_thread.h"
#include "tests/simulation/stories.h"
#include "tests/simulation/walk_run.h"

using namespace lightwalk;
using namespace lightwalk::simulation;

namespace {

View first_view() {
    View view;
    view.position = {0.3, -3.5, 1.5};
    view.direction = {0.1, 1, -0.1};
    view.horizontal = 60;
    view.vertical = 44;
    return view;
}

/// What is wanted after a step.
WalkStep next_step(Chance& chance, WalkStep step) {
    step.keeps_some = step.refused = step.looks_aside = step.settles = false;
    View& view = step.view;
    const auto turn = [&](double angle) {
        const double x = view.direction.x, y = view.direction.y;
        view.direction.x = std::cos(angle) * x - std::sin(angle) * y;
        view.direction.y = std::sin(angle) * x + std::cos(angle) * y;
    };
    switch (chance.below(8)) {
        case 0:
            turn(chance.percent(70) ? 0.05 : 1.5);
            break;
        case 1:
            view.position.y = std::min(view.position.y + 0.1, 0.5);
            break;
        case 2:
            view.position.x = std::max(view.position.x - 0.08, -2.0);
            turn(-0.04);
            break;
        case 3:
            step.width = one_of(chance, {20, 11, 26, 3});
            step.height = one_of(chance, {14, 7, 17, 2});
            break;
        case 4:
            step.mixture = one_of<LightMixture>(
                chance, {{}, {{{1, .5F, .25F}, {.5F, 1, 1}}}, {{{.25F, .25F, .25F}, {1, 1, 1}}}});
            break;
        case 5:
            step.keeps_some = chance.percent(50);
            ++(step.keeps_some ? step.room.screen : step.room.light);
            break;
        default:
            break;  // it rests
    }
    step.refused = chance.percent(5);
    step.looks_aside = chance.percent(20);
    step.settles = chance.percent(15);
    return step;
}

std::vector<WalkStep> some_steps(Chance& chance) {
    std::vector<WalkStep> steps(1);
    steps[0].view = first_view();
    for (int left = 1 + chance.below(6); left > 0; --left)
        steps.push_back(next_step(chance, steps.back()));
    steps.back().settles = chance.percent(60);
    return steps;
}

CloudOptions some_cloud(Chance& chance) {
    CloudOptions cloud;
    cloud.budget = one_of(chance, {0.0, 0.0, 0.02, 0.2, 2.0});
    cloud.refine = one_of(chance, {0.3, 1.0});
    cloud.samples = cloud.budget > 0 ? 1 : one_of(chance, {1, 1, 2});
    cloud.check = one_of(chance, {CloudCheck::all, CloudCheck::rotating, CloudCheck::rotating});
    cloud.audit = cloud.budget > 0 ? 0 : one_of(chance, {0.0, 0.2});
    cloud.audit_limit = 0.001;
    return cloud;
}

WalkPlan some_walk_plan(Chance& chance, bool with_faults) {
    WalkPlan plan;
    plan.variant = one_of(chance, {Variant::ranks, Variant::hybrid, Variant::hybrid});
    plan.ranks = one_of(chance, {2, 3, 3, 4, 4, 6});
    plan.masters = plan.ranks == 6 ? one_of(chance, {1, 2}) : 1;
    plan.slots = plan.variant == Variant::hybrid ? one_of(chance, {1, 2}) : 1;
    plan.ahead = one_of(chance, {0, 1});
    plan.projectors = one_of(chance, {32, 32, 2, 1});
    // Long ones are dear: signs of life come and go meanwhile.
    plan.longest_delay =
        one_of<Time>(chance, {milliseconds(1), milliseconds(1), milliseconds(1), milliseconds(200),
                              milliseconds(200), milliseconds(200), seconds(3), seconds(10)});
    plan.longest_work = one_of<Time>(chance, {milliseconds(1), milliseconds(20), milliseconds(20),
                                              milliseconds(300), milliseconds(300), seconds(4)});
    plan.broadcasts = chance.percent(20);
    plan.apart = chance.percent(30);
    plan.groups = chance.percent(40);
    plan.cloud = some_cloud(chance);
    if (with_faults)
        for (int left = one_of(chance, {0, 1, 1, 1, 2}); left > 0; --left)
            plan.faults.push_back(some_fault(chance, plan, 400));
    return plan;
}

class WalkPlayer {
  public:
    /// Runs until the walk is at its end: where one is lost, the next goes on from the view that it
    /// was at, with as many ranks as there are then, and knows nothing of before.
    [[nodiscard]] Story play(std::uint64_t seed, const Planted& planted) {
        constexpr int kMostRuns = 3;
        Chance chance(seed);
        WalkProgress progress{some_steps(chance), 0};
        Story story;
        for (bool finished = false; !finished && story.wrong.empty();) {
            const WalkPlan plan = some_walk_plan(chance, story.runs + 1 < kMostRuns);
            // The last steps may all be taken where a run is lost: somebody still looks.
            progress.at = std::min(progress.at, progress.steps.size() - 1);
            WalkRun run(*fibers_, plan, planted, stage_, progress, chance.number());
            const Outcome outcome = run.play();
            finished = outcome.finished;
            story.add(description_of(plan) + "; from step " + std::to_string(run.first_step()) +
                          " of " + std::to_string(progress.steps.size()),
                      outcome);
        }
        return story;
    }

  private:
    std::unique_ptr<Fibers> fibers_ = make_context_fibers(kMostThreads);
    WalkStage stage_;
};

#if defined(__SANITIZE_ADDRESS__)
constexpr std::uint64_t kWalks = 250;
#else
constexpr std::uint64_t kWalks = 4000;
#endif

/// An owner of a part begins anew in the third frame, as if it had seen none.
int forget_points(Packet& packet, int& seen) {
    Message message = decode_message(packet.bytes);
    auto* const told = std::get_if<Announcement>(&message);
    auto* const order = told != nullptr ? std::get_if<FrameOrder>(&told->job) : nullptr;
    if (order == nullptr || order->rests || order->rules.empty || ++seen != 3) return 1;
    order->rules.empty = true;
    packet.bytes = encode_message(message);
    return 1;
}

/// The part of the frame before, with the number of this one.
int keep_old_part(Packet& packet, std::map<int, FramePart>& before, int& seen) {
    Message message = decode_message(packet.bytes);
    auto* const finished = std::get_if<FinishedPart>(&message);
    if (finished == nullptr) return 1;
    auto& part = std::get<FramePart>(finished->part);
    const auto old = before.find(packet.from);
    const FramePart own = part;
    if (old != before.end() && old->second.area == part.area && ++seen == 2) {
        part.pixels = old->second.pixels;
        part.unknown = old->second.unknown;
        part.refined = old->second.refined;
        packet.bytes = encode_message(message);
    }
    before[packet.from] = own;
    return 1;
}

}  // namespace

TEST_CASE(
    "simulation: walks on ranks that fail are lost as promised, go on where they were, and have "
    "the frames of one process" *
    test::one_thread) {
    check_stories<WalkPlayer>(kWalks);
}

TEST_CASE("simulation: a walk's seed is played twice in the same way" * test::one_thread) {
    check_same_twice<WalkPlayer>();
}

TEST_CASE("simulation: errors that are planted in walks are found within some hundred seeds" *
          test::about_numbers) {
    const auto any = [](const Packet&, const Message&) { return true; };
    const auto run = [](const Packet&, const Message& message) {
        const auto* result = std::get_if<WorkResult>(&message);
        return result != nullptr && std::holds_alternative<TracedRun>(result->result);
    };
    const auto points = [](const Packet&, const Message& message) {
        const auto* exchange = std::get_if<PointExchange>(&message);
        return exchange != nullptr && std::holds_alternative<SharedPoints>(exchange->points);
    };
    const auto used = [](const Packet&, const Message& message) {
        const auto* exchange = std::get_if<PointExchange>(&message);
        return exchange != nullptr && std::holds_alternative<UsedPixels>(exchange->points);
    };
    const auto part = [](const Packet&, const Message& message) {
        return std::holds_alternative<FinishedPart>(message);
    };
    const auto grant = [](const Packet&, const Message& message) {
        return std::holds_alternative<WorkGrant>(message);
    };
    const auto forget = [seen = 0](Packet& packet) mutable { return forget_points(packet, seen); };
    const auto old = [before = std::map<int, FramePart>(), seen = 0](Packet& packet) mutable {
        return keep_old_part(packet, before, seen);
    };
    const PlantedError errors[] = {
        {"a message is lost on the way", {once(0, 60, any), false, false}},
        {"a message arrives twice", {once(2, 60, any), false, false}},
        {"a run of traced pixels is lost", {once(0, 5, run), false, false}},
        {"a run of traced pixels comes twice", {once(2, 5, run), false, false}},
        {"pixels are handed out twice", {once(2, 4, grant), false, false}},
        {"points on their way to another owner are lost", {once(0, 5, points), false, false}},
        {"points on their way to another owner come twice", {always(2, points), false, false}},
        {"which points were used comes twice", {always(2, used), false, false}},
        {"a part of a frame comes twice", {once(2, 3, part), false, false}},
        {"an owner forgets its points", {forget, false, false}},
        {"a part of an old frame is taken for that of the new one", {old, false, false}},
        {"signs of life are lost", {lose_alive, false, false}},
        {"nobody loses patience", {nullptr, false, true}},
    };
    for (const PlantedError& error : errors) check_found<WalkPlayer>(error);
}
