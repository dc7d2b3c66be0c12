// Work that waits in the middle, on stacks of its own.
#include "core/wave/fibers.h"

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace lightwalk {
namespace {

/// Goes down by some hundred bytes a step until the fiber says that there is no room.
std::size_t steps_down(const Fibers& fibers) {
    std::array<volatile char, 200> used{};
    used[0] = 1;
    return fibers.has_room() ? 1 + steps_down(fibers) + static_cast<std::size_t>(used[1]) : 0;
}

}  // namespace

TEST_CASE("fibers: work waits where it likes and goes on with what it had") {
    Fibers fibers(3);
    std::string told;
    const auto work = [&] {
        const std::string own = told.empty() ? "a" : "b";
        for (int i = 1; i < 3; ++i) {
            told += own + std::to_string(i);
            fibers.wait();
        }
        told += own + "3";
    };
    REQUIRE(fibers.prepare(0));
    REQUIRE(fibers.prepare(2));
    CHECK_FALSE(fibers.start(0, work));
    CHECK_FALSE(fibers.start(2, work));
    CHECK_FALSE(fibers.resume(0));
    CHECK(fibers.resume(0));
    CHECK_FALSE(fibers.resume(2));
    CHECK(fibers.resume(2));
    CHECK(told == "a1b1a2a3b2b3");
}

TEST_CASE("fibers: one is used again and again, for work that waits or does not") {
    Fibers fibers(1);
    REQUIRE(fibers.prepare(0));
    int sum = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto add = [&] {
            if (i % 3 == 0) fibers.wait();
            sum += i;
        };
        if (!fibers.start(0, add)) CHECK(fibers.resume(0));
    }
    CHECK(sum == 999 * 500);
}

TEST_CASE("fibers: exceptions that stay within the work are no one else's") {
    Fibers fibers(2);
    int caught = 0;
    const auto work = [&] {
        try {
            fibers.wait();
            throw 7;
        } catch (int thrown) {
            caught += thrown;
        }
    };
    for (const std::size_t i : {0, 1}) {
        REQUIRE(fibers.prepare(i));
        CHECK_FALSE(fibers.start(i, work));
    }
    for (const std::size_t i : {1, 0}) CHECK(fibers.resume(i));
    CHECK(caught == 14);
}

TEST_CASE("fibers: there is room for half of the stack") {
    Fibers fibers(1);
    REQUIRE(fibers.prepare(0));
    std::size_t steps = 0;
    CHECK(fibers.start(0, [&] { steps = steps_down(fibers); }));
    CHECK(steps > 100);
    CHECK(steps < Fibers::kStackBytes / 2 / 200);
}

}  // namespace lightwalk
