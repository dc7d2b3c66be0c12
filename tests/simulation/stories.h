#pragma once
// Stories: runs, one after the other, until all is drawn, each of which follows from a seed.
//   LIGHTWALK_SEEDS=100000 lightwalk_tests -tc="simulation*"          more of them
//   LIGHTWALK_SEED=17 lightwalk_tests -tc="simulation: pictures*"     one of them, and what befalls
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "parallel/work_queue/message.h"
#include "tests/simulation/rank_run.h"

namespace lightwalk::simulation {

inline constexpr std::size_t kMostThreads = 64;  ///< of all ranks of a run

template <class T>
T one_of(Chance& chance, std::initializer_list<T> list) {
    return *(list.begin() + chance.below(static_cast<int>(list.size())));
}

/// @param messages  of a short run
inline Fault some_fault(Chance& chance, const RankPlan& plan, int messages) {
    using Kind = Fault::Kind;
    Fault fault;
    fault.kind =
        one_of(chance, {Kind::stop, Kind::stop, Kind::stop, Kind::unplug, Kind::unplug, Kind::kill,
                        Kind::kill, Kind::cut, Kind::cut, Kind::cut, Kind::fail, Kind::interrupt});
    fault.rank = chance.below(plan.ranks);
    // Where much happens, or where nothing does.
    if (chance.percent(70))
        fault.message = 1 + static_cast<std::uint64_t>(chance.below(messages));
    else
        fault.time = chance.up_to(20 * (plan.longest_delay + plan.longest_work));
    if (fault.passes())
        fault.lasts = chance.up_to(one_of<Time>(chance, {seconds(11), seconds(60)}));
    return fault;
}

struct Story {
    std::string wrong;  ///< "": nothing
    std::string told;   ///< of each run
    int runs = 0;
    bool lost = false;  ///< whether a run ended before all was drawn

    /// A run is over.
    void add(const std::string& description, const Outcome& outcome) {
        ++runs;
        wrong = outcome.wrong;
        lost = lost || !outcome.finished;
        std::ostringstream text;
        text << "  " << description << "\n    -> "
             << (outcome.finished ? "finished" : "not finished") << " after "
             << in_seconds(outcome.end) << " s, " << outcome.messages << " messages";
        for (const std::string& failure : outcome.failures) text << "; " << failure;
        text << (wrong.empty() ? "" : "; WRONG: ") << wrong << "\n";
        told += text.str();
    }
};

/// The first seed of some whose story is wrong, if any.
struct Tally {
    std::optional<std::uint64_t> seed;
    Story story;
    std::uint64_t lost = 0;
    std::uint64_t wrong = 0;
    std::string others;  ///< some of the wrong ones, and what is wrong
};

/// @tparam Player  plays the story of a seed; each thread has its own
template <class Player>
Tally play_all(std::uint64_t count) {
    Tally tally;
    std::mutex mutex;  // guards the tally
    std::atomic<std::uint64_t> next{0};
    const auto work = [&] {
        Player player;
        for (std::uint64_t seed = next++; seed < count; seed = next++) {
            const Story story = player.play(seed, Planted{});
            const std::lock_guard lock(mutex);
            tally.lost += story.lost ? 1 : 0;
            if (story.wrong.empty()) continue;
            constexpr std::uint64_t kMostTold = 12;
            if (++tally.wrong <= kMostTold)
                tally.others += "  " + std::to_string(seed) + ": " + story.wrong + "\n";
            if (tally.seed && *tally.seed < seed) continue;
            tally.seed = seed;
            tally.story = story;
        }
    };
    std::vector<std::jthread> threads(std::max(1U, std::thread::hardware_concurrency()));
    for (std::jthread& thread : threads) thread = std::jthread(work);
    threads.clear();
    return tally;
}

inline std::optional<std::uint64_t> number_from(const char* variable) {
    const char* const text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets
    if (text == nullptr) return std::nullopt;
    return std::stoull(text);
}

/// One story, or all of them, as the environment says.
template <class Player>
void check_stories(std::uint64_t count) {
    if (const auto seed = number_from("LIGHTWALK_SEED")) {
        const Story story = Player().play(*seed, Planted{});
        std::cout << "seed " << *seed << ":\n" << story.told;
        CHECK(story.wrong == "");
        return;
    }
    const std::uint64_t seeds = number_from("LIGHTWALK_SEEDS").value_or(count);
    const Tally tally = play_all<Player>(seeds);
    if (tally.seed) {
        FAIL_CHECK(tally.wrong << " of " << seeds << " seeds; LIGHTWALK_SEED=" << *tally.seed
                               << ":\n"
                               << tally.story.told << tally.others);
    }
    // Both ways to end are tried.
    CHECK(tally.lost > seeds / 10);
    CHECK(tally.lost < seeds / 10 * 9);
}

template <class Player>
void check_same_twice() {
    Player player;
    for (std::uint64_t seed = 0; seed < 50; ++seed)
        CHECK(player.play(seed, Planted{}).told == player.play(seed, Planted{}).told);
}

/// An error that is planted.
struct PlantedError {
    std::string what;
    Planted planted;
};

/// How many seeds it takes until it is found, and as what.
template <class Player>
void check_found(const PlantedError& error) {
    constexpr std::uint64_t kMost = 300;
    CAPTURE(error.what);
    Player player;
    for (std::uint64_t seed = 0; seed < kMost; ++seed) {
        const Story story = player.play(seed, error.planted);
        if (story.wrong.empty()) continue;
        MESSAGE(error.what << ": found after " << seed + 1 << " seeds: " << story.wrong);
        return;
    }
    FAIL_CHECK("not found");
}

inline bool is_alive(const Message& message) {
    const auto* notice = std::get_if<Notice>(&message);
    return notice != nullptr && std::holds_alternative<Alive>(notice->notice);
}

/// A mishap of the nth message that is as wanted, in each world.
template <class Wanted>
Mishap once(int copies, int nth, Wanted wanted) {
    return [copies, nth, wanted, seen = 0](const Packet& packet) mutable {
        const Message message = decode_message(packet.bytes);
        if (is_alive(message) || !wanted(packet, message)) return 1;
        return ++seen == nth ? copies : 1;
    };
}

/// A mishap of all such messages.
template <class Wanted>
Mishap always(int copies, Wanted wanted) {
    return [copies, wanted](const Packet& packet) {
        return wanted(packet, decode_message(packet.bytes)) ? copies : 1;
    };
}

/// Signs of life are lost.
inline int lose_alive(const Packet& packet) {
    return is_alive(decode_message(packet.bytes)) ? 0 : 1;
}

}  // namespace lightwalk::simulation
