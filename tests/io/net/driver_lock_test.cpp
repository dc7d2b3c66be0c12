#include "io/net/driver_lock.h"

#include <doctest/doctest.h>

#include <string>

using namespace lightwalk;

namespace {

constexpr ClientId kOne{1}, kTwo{2}, kThree{3};

View standing_at(double x) {
    View view;
    view.position = {x, 0, 0};
    return view;
}

}  // namespace

TEST_CASE("driver lock: the first drives, others watch, until it leaves or hands over") {
    DriverLock lock;
    CHECK(lock.join(kOne, "a"));
    CHECK(lock.join(kTwo, "b"));
    CHECK_FALSE(lock.join(kTwo, "b"));
    CHECK(lock.drives(kOne));
    CHECK_FALSE(lock.acquire(kTwo));
    CHECK_FALSE(lock.hand(kTwo, kTwo));
    CHECK_FALSE(lock.hand(kOne, kThree));
    CHECK(lock.drives("a"));
    CHECK(lock.hand(kOne, kTwo));
    CHECK(lock.drives(kTwo));
    CHECK(lock.drives("b"));
    CHECK_FALSE(lock.drives("a"));
    lock.leave(kTwo);
    CHECK_FALSE(lock.drives("b"));
    CHECK_FALSE(lock.driver());
    CHECK_FALSE(lock.acquire(kThree));
    CHECK(lock.acquire(kOne));
    CHECK(lock.clients() == std::vector{kOne});
}

TEST_CASE("driver lock: who returns finds the place where it stood, and nobody else does") {
    DriverLock lock;
    lock.join(kOne, "a");
    CHECK_FALSE(lock.place(kOne));
    lock.remember(kOne, standing_at(5));
    lock.leave(kOne);
    lock.join(kTwo, "b");
    CHECK_FALSE(lock.place(kTwo));
    lock.join(kThree, "a");
    REQUIRE(lock.place(kThree));
    CHECK(lock.place(kThree)->position.x == 5);
    CHECK_FALSE(lock.place(kOne));
}

TEST_CASE("driver lock: a driver whose old connection is not known to be lost drives on") {
    DriverLock lock;
    lock.join(kOne, "a");
    lock.join(kTwo, "b");
    lock.join(kThree, "a");
    CHECK(lock.drives(kThree));
    lock.leave(kOne);
    CHECK(lock.drives(kThree));
}

TEST_CASE("driver lock: sessions are remembered up to a limit, the oldest are forgotten") {
    DriverLock lock;
    for (std::uint32_t i = 0; i <= DriverLock::kMostSessions; ++i) {
        lock.join(ClientId{i}, std::to_string(i));
        lock.remember(ClientId{i}, standing_at(i));
        lock.leave(ClientId{i});
    }
    lock.join(ClientId{1000}, "0");
    CHECK_FALSE(lock.place(ClientId{1000}));
    lock.join(ClientId{1001}, "64");
    CHECK(lock.place(ClientId{1001}));
}
