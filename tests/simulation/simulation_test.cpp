// Ranks that fail: thousands of runs, each of which follows from its seed.
//   LIGHTWALK_SEEDS=100000 lightwalk_tests -tc="simulation*"   more of them
//   LIGHTWALK_SEED=17 lightwalk_tests -tc="simulation: p*"     one of them, and what befalls it
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "parallel/fibers/context_fibers.h"
#include "parallel/work_queue/message.h"
#include "tests/one_thread.h"
#include "tests/simulation/picture_run.h"

using namespace lightwalk;
using namespace lightwalk::simulation;

namespace {

constexpr std::size_t kMostThreads = 64;  ///< of all ranks of a run

std::optional<std::uint64_t> number_from(const char* variable) {
    const char* const text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets
    if (text == nullptr) return std::nullopt;
    return std::stoull(text);
}

template <class T>
T one_of(Chance& chance, std::initializer_list<T> list) {
    return *(list.begin() + chance.below(static_cast<int>(list.size())));
}

Fault some_fault(Chance& chance, const Plan& plan) {
    using Kind = Fault::Kind;
    Fault fault;
    fault.kind =
        one_of(chance, {Kind::stop, Kind::stop, Kind::stop, Kind::unplug, Kind::unplug, Kind::kill,
                        Kind::kill, Kind::cut, Kind::cut, Kind::cut, Kind::fail, Kind::interrupt});
    fault.rank = chance.below(plan.ranks);
    // Where much happens, or where nothing does.
    if (chance.percent(70))
        fault.message = 1 + static_cast<std::uint64_t>(chance.below(200));
    else
        fault.time = chance.up_to(20 * (plan.longest_delay + plan.longest_block));
    if (fault.passes())
        fault.lasts = chance.up_to(one_of<Time>(chance, {seconds(11), seconds(60)}));
    return fault;
}

Plan some_plan(Chance& chance, bool with_faults) {
    Plan plan;
    plan.variant = one_of(chance, {Variant::ranks, Variant::hybrid});
    plan.ranks = one_of(chance, {2, 3, 4, 4, 4, 6});
    plan.masters = plan.ranks == 6 ? one_of(chance, {1, 2}) : 1;
    plan.slots = plan.variant == Variant::hybrid ? one_of(chance, {1, 2}) : 1;
    plan.ahead = one_of(chance, {0, 1, 2});
    plan.block = one_of(chance, {8, 8, 8, 8, 8, 16, 16, 16, 16, 0});
    plan.stride = one_of(chance, {0, 1, 3});
    plan.pictures = one_of(chance, {1, 1, 1, 2});
    plan.longest_delay =
        one_of<Time>(chance, {milliseconds(1), milliseconds(200), seconds(3), seconds(10)});
    plan.longest_block = one_of<Time>(chance, {milliseconds(10), milliseconds(300), seconds(4)});
    plan.broadcasts = chance.percent(30);
    if (with_faults)
        for (int left = one_of(chance, {0, 1, 1, 1, 2}); left > 0; --left)
            plan.faults.push_back(some_fault(chance, plan));
    return plan;
}

struct Story {
    std::string wrong;  ///< "": nothing
    std::string told;   ///< of each run
    int runs = 0;
    bool lost = false;  ///< whether a run ended without its pictures
};

/// A checkpoint that the master's death has cut off has all blocks but the last few.
void lose_unwritten(Disk& disk, Chance& chance) {
    for (auto& [number, blocks] : disk)
        blocks.resize(blocks.size() - std::min<std::size_t>(blocks.size(), static_cast<std::size_t>(
                                                                               chance.below(3))));
}

/// Runs until the pictures are drawn: what is left after one is for the next, on as many ranks as
/// there are then.
Story play(std::uint64_t seed, Fibers& fibers, const Planted& planted = {}) {
    constexpr int kMostRuns = 3;
    Chance chance(seed);
    Disk disk;
    Story story;
    std::ostringstream told;
    const int pictures = one_of(chance, {1, 1, 1, 2});
    for (bool finished = false; !finished && story.wrong.empty(); ++story.runs) {
        Plan plan = some_plan(chance, story.runs + 1 < kMostRuns);
        plan.pictures = pictures;
        PictureRun run(fibers, plan, planted, disk, chance.number());
        const Outcome outcome = run.play();
        finished = outcome.finished;
        story.wrong = outcome.wrong;
        story.lost = story.lost || !finished;
        told << "  " << description_of(plan) << "\n    -> "
             << (finished ? "finished" : "not finished") << " after "
             << std::chrono::duration<double>(outcome.end).count() << " s, " << outcome.messages
             << " messages";
        for (const std::string& failure : outcome.failures) told << "; " << failure;
        told << (outcome.wrong.empty() ? "" : "; WRONG: ") << outcome.wrong << "\n";
        if (!finished) lose_unwritten(disk, chance);
    }
    story.told = told.str();
    return story;
}

/// The first seed of `count` whose story is wrong, if any.
struct Tally {
    std::optional<std::uint64_t> seed;
    Story story;
    std::uint64_t lost = 0;
    std::uint64_t wrong = 0;
};
Tally play_all(std::uint64_t first, std::uint64_t count) {
    Tally tally;
    std::mutex mutex;  // guards the tally
    std::atomic<std::uint64_t> next{0};
    const auto work = [&] {
        const auto fibers = make_context_fibers(kMostThreads);
        for (std::uint64_t i = next++; i < count; i = next++) {
            const Story story = play(first + i, *fibers);
            const std::lock_guard lock(mutex);
            tally.lost += story.lost ? 1 : 0;
            if (story.wrong.empty()) continue;
            ++tally.wrong;
            if (tally.seed && *tally.seed < first + i) continue;
            tally.seed = first + i;
            tally.story = story;
        }
    };
    std::vector<std::jthread> threads(std::max(1U, std::thread::hardware_concurrency()));
    for (std::jthread& thread : threads) thread = std::jthread(work);
    threads.clear();
    return tally;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr std::uint64_t kSeeds = 500;
#else
constexpr std::uint64_t kSeeds = 10000;
#endif

/// How many seeds it takes until the planted error is found, and as what; nothing: none of so many
/// does.
std::optional<std::pair<std::uint64_t, std::string>> seeds_to_find(const Planted& planted) {
    constexpr std::uint64_t kMost = 300;
    const auto fibers = make_context_fibers(kMostThreads);
    for (std::uint64_t seed = 0; seed < kMost; ++seed)
        if (const Story story = play(seed, *fibers, planted); !story.wrong.empty())
            return std::pair(seed + 1, story.wrong);
    return std::nullopt;
}

/// A mishap of the nth message that is as wanted, in each world.
template <class Wanted>
Mishap once(int copies, int nth, Wanted wanted) {
    return [copies, nth, wanted, seen = 0](const Packet& packet) mutable {
        const Message message = decode_message(packet.bytes);
        const auto* notice = std::get_if<Notice>(&message);
        if (notice != nullptr && std::holds_alternative<Alive>(notice->notice)) return 1;
        if (!wanted(packet, message)) return 1;
        return ++seen == nth ? copies : 1;
    };
}

}  // namespace

TEST_CASE(
    "simulation: pictures on ranks that fail are lost as promised, resumed, and have the same "
    "bytes" *
    test::one_thread) {
    if (const auto seed = number_from("LIGHTWALK_SEED")) {
        const auto fibers = make_context_fibers(kMostThreads);
        const Story story = play(*seed, *fibers);
        std::cout << "seed " << *seed << ":\n" << story.told;
        CHECK(story.wrong == "");
        return;
    }
    const std::uint64_t seeds = number_from("LIGHTWALK_SEEDS").value_or(kSeeds);
    const Tally tally = play_all(0, seeds);
    if (tally.seed) {
        FAIL_CHECK(tally.wrong << " of " << seeds << " seeds; LIGHTWALK_SEED=" << *tally.seed
                               << ":\n"
                               << tally.story.told);
    }
    // Both ways to end are tried.
    CHECK(tally.lost > seeds / 10);
    CHECK(tally.lost < seeds / 10 * 9);
}

TEST_CASE("simulation: a seed is played twice in the same way" * test::one_thread) {
    const auto fibers = make_context_fibers(kMostThreads);
    for (std::uint64_t seed = 0; seed < 50; ++seed)
        CHECK(play(seed, *fibers).told == play(seed, *fibers).told);
}

TEST_CASE("simulation: errors that are planted are found within some hundred seeds" *
          test::one_thread) {
    struct Error {
        std::string what;
        Planted planted;
    };
    const auto is_alive = [](const Message& message) {
        const auto* notice = std::get_if<Notice>(&message);
        return notice != nullptr && std::holds_alternative<Alive>(notice->notice);
    };
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
    const Error errors[] = {
        {"a message is lost on the way", {once(0, 40, any), false, false}},
        {"a message arrives twice", {once(2, 40, any), false, false}},
        {"the result of a block is dropped", {once(0, 3, block), false, false}},
        {"a block is granted twice", {once(2, 3, grant), false, false}},
        {"a block is kept twice", {once(2, 3, logged), false, false}},
        {"signs of life are lost",
         {[&](const Packet& packet) { return is_alive(decode_message(packet.bytes)) ? 0 : 1; },
          false, false}},
        {"a block that was kept is not passed on", {nullptr, true, false}},
        {"nobody loses patience", {nullptr, false, true}},
    };
    for (const Error& error : errors) {
        const auto found = seeds_to_find(error.planted);
        CAPTURE(error.what);
        REQUIRE(found.has_value());
        MESSAGE(error.what << ": found after " << found->first << " seeds: " << found->second);
    }
}
