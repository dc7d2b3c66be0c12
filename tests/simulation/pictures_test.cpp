// Pictures on ranks that fail: thousands of stories.
#include <doctest/doctest.h>

#include <algorithm>
#include <variant>

#include "parallel/fibers/context_fibers.h"
#include "tests/one_thread.h"
#include "tests/simulation/picture_run.h"
#include "tests/simulation/stories.h"

using namespace lightwalk;
using namespace lightwalk::simulation;

namespace {

PicturePlan some_picture_plan(Chance& chance, bool with_faults) {
    PicturePlan plan;
    plan.variant = one_of(chance, {Variant::ranks, Variant::hybrid});
    plan.ranks = one_of(chance, {2, 3, 4, 4, 4, 6});
    plan.masters = plan.ranks == 6 ? one_of(chance, {1, 2}) : 1;
    plan.slots = plan.variant == Variant::hybrid ? one_of(chance, {1, 2}) : 1;
    plan.ahead = one_of(chance, {0, 1, 2});
    plan.block = one_of(chance, {8, 8, 8, 8, 8, 16, 16, 16, 16, 0});
    plan.stride = one_of(chance, {0, 1, 3});
    plan.longest_delay =
        one_of<Time>(chance, {milliseconds(1), milliseconds(200), seconds(3), seconds(10)});
    plan.longest_work = one_of<Time>(chance, {milliseconds(10), milliseconds(300), seconds(4)});
    plan.broadcasts = chance.percent(30);
    if (with_faults)
        for (int left = one_of(chance, {0, 1, 1, 1, 2}); left > 0; --left)
            plan.faults.push_back(some_fault(chance, plan, 200));
    return plan;
}

/// A checkpoint that the master's death has cut off has all blocks but the last few.
void lose_unwritten(Disk& disk, Chance& chance) {
    for (auto& [number, blocks] : disk)
        blocks.resize(blocks.size() - std::min<std::size_t>(blocks.size(), static_cast<std::size_t>(
                                                                               chance.below(3))));
}

class PicturePlayer {
  public:
    /// Runs until the pictures are drawn: what is left after one is for the next, on as many ranks
    /// as there are then.
    [[nodiscard]] Story play(std::uint64_t seed, const Planted& planted) {
        constexpr int kMostRuns = 3;
        Chance chance(seed);
        Disk disk;
        Story story;
        const int pictures = one_of(chance, {1, 1, 1, 2});
        for (bool finished = false; !finished && story.wrong.empty();) {
            PicturePlan plan = some_picture_plan(chance, story.runs + 1 < kMostRuns);
            plan.pictures = pictures;
            PictureRun run(*fibers_, plan, planted, disk, chance.number());
            const Outcome outcome = run.play();
            finished = outcome.finished;
            story.add(description_of(plan), outcome);
            if (!finished) lose_unwritten(disk, chance);
        }
        return story;
    }

  private:
    std::unique_ptr<Fibers> fibers_ = make_context_fibers(kMostThreads);
};

#if defined(__SANITIZE_ADDRESS__)
constexpr std::uint64_t kPictures = 500;
#else
constexpr std::uint64_t kPictures = 10000;
#endif

}  // namespace

TEST_CASE(
    "simulation: pictures on ranks that fail are lost as promised, resumed, and have the same "
    "bytes" *
    test::one_thread) {
    check_stories<PicturePlayer>(kPictures);
}

TEST_CASE("simulation: a picture's seed is played twice in the same way" * test::one_thread) {
    check_same_twice<PicturePlayer>();
}

TEST_CASE("simulation: errors that are planted in pictures are found within some hundred seeds" *
          test::about_numbers) {
    const auto any = [](const Packet&, const Message&) { return true; };
    const auto block = [](const Packet&, const Message& message) {
        const auto* result = std::get_if<WorkResult>(&message);
        return result != nullptr && std::holds_alternative<Pixels>(result->result);
    };
    const auto logged = [](const Packet& packet, const Message& message) {
        return packet.to == 0 && std::holds_alternative<WorkResult>(message);
    };
    const auto grant = [](const Packet&, const Message& message) {
        return std::holds_alternative<WorkGrant>(message);
    };
    const PlantedError errors[] = {
        {"a message is lost on the way", {once(0, 40, any), false, false}},
        {"a message arrives twice", {once(2, 40, any), false, false}},
        {"the result of a block is dropped", {once(0, 3, block), false, false}},
        {"a block is granted twice", {once(2, 3, grant), false, false}},
        {"a block is kept twice", {once(2, 3, logged), false, false}},
        {"signs of life are lost", {lose_alive, false, false}},
        {"a block that was kept is not passed on", {nullptr, true, false}},
        {"nobody loses patience", {nullptr, false, true}},
    };
    for (const PlantedError& error : errors) check_found<PicturePlayer>(error);
}
