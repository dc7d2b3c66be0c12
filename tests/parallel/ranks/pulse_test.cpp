#include "parallel/ranks/pulse.h"

#include <doctest/doctest.h>

using namespace lightwalk;
using Seconds = std::chrono::seconds;

namespace {

constexpr Pulse::Times kTimes{Seconds(2), Seconds(30)};

/// A rank's pulse, second by second.
struct Watch {
    explicit Watch(int rank) : pulse(rank, 4, kTimes) { pulse.start(now); }
    /// @param heard  ranks that say something each second
    std::optional<int> pass(int count, const std::vector<int>& heard) {
        std::optional<int> lost;
        for (int i = 0; i < count && !lost; ++i) {
            now += Seconds(1);
            for (const int from : heard) pulse.heard(from, now);
            const Pulse::Beat beat = pulse.beat(now);
            told += beat.due ? 1 : 0;
            lost = beat.lost;
        }
        return lost;
    }
    Pulse::Time now;
    Pulse pulse;
    int told = 0;
};

}  // namespace

TEST_CASE("pulse: rank 0 watches all others, and they watch rank 0") {
    Watch first(0);
    CHECK_FALSE(first.pass(100, {1, 2, 3}));
    CHECK(first.told == 50);
    CHECK_FALSE(first.pass(30, {1, 3}));
    CHECK(first.pass(2, {1, 3}) == 2);
    Watch second(1);
    CHECK_FALSE(second.pass(100, {0}));
    CHECK(second.pass(100, {2, 3}) == 0);
}

TEST_CASE("pulse: who did not run for a while blames nobody for that") {
    Watch first(0);
    CHECK_FALSE(first.pass(20, {1, 2}));
    first.now += Seconds(3600);  // stopped by a signal, all of them
    CHECK_FALSE(first.pass(9, {1, 2}));
    CHECK(first.pass(5, {1, 2}) == 3);
}

TEST_CASE("pulse: who is heard first thing after such a while is watched from then on") {
    Watch first(0);
    CHECK_FALSE(first.pass(20, {1, 2, 3}));
    first.now += Seconds(3600);
    CHECK_FALSE(first.pass(1, {1, 2, 3}));
    CHECK_FALSE(first.pass(28, {1, 2}));
    CHECK(first.pass(5, {1, 2}) == 3);
}

TEST_CASE("pulse: nothing is told or watched before it starts") {
    Pulse pulse(0, 2, kTimes);
    for (int i = 0; i < 100; ++i) {
        pulse.heard(1, Pulse::Time(Seconds(i)));
        const Pulse::Beat beat = pulse.beat(Pulse::Time(Seconds(1000 * i)));
        CHECK_FALSE(beat.due);
        CHECK_FALSE(beat.lost);
    }
}
