#include "io/net/walk_seats.h"

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

TEST_CASE("seats: the first drives, others watch, until it leaves or hands over") {
    WalkSeats seats;
    CHECK(seats.join(kOne, "a"));
    CHECK(seats.join(kTwo, "b"));
    CHECK_FALSE(seats.join(kTwo, "b"));
    CHECK(seats.drives(kOne));
    CHECK_FALSE(seats.take(kTwo));
    CHECK_FALSE(seats.hand(kTwo, kTwo));
    CHECK_FALSE(seats.hand(kOne, kThree));
    CHECK(seats.hand(kOne, kTwo));
    CHECK(seats.drives(kTwo));
    seats.leave(kTwo);
    CHECK_FALSE(seats.driver());
    CHECK_FALSE(seats.take(kThree));
    CHECK(seats.take(kOne));
    CHECK(seats.clients() == std::vector{kOne});
}

TEST_CASE("seats: who returns finds the place where it stood, and nobody else does") {
    WalkSeats seats;
    seats.join(kOne, "a");
    CHECK_FALSE(seats.place(kOne));
    seats.remember(kOne, standing_at(5));
    seats.leave(kOne);
    seats.join(kTwo, "b");
    CHECK_FALSE(seats.place(kTwo));
    seats.join(kThree, "a");
    REQUIRE(seats.place(kThree));
    CHECK(seats.place(kThree)->position.x == 5);
    CHECK_FALSE(seats.place(kOne));
}

TEST_CASE("seats: a driver whose old connection is not known to be lost drives on") {
    WalkSeats seats;
    seats.join(kOne, "a");
    seats.join(kTwo, "b");
    seats.join(kThree, "a");
    CHECK(seats.drives(kThree));
    seats.leave(kOne);
    CHECK(seats.drives(kThree));
}

TEST_CASE("seats: sessions are remembered up to a limit, the oldest are forgotten") {
    WalkSeats seats;
    for (std::uint32_t i = 0; i <= WalkSeats::kMostSessions; ++i) {
        seats.join(ClientId{i}, std::to_string(i));
        seats.remember(ClientId{i}, standing_at(i));
        seats.leave(ClientId{i});
    }
    seats.join(ClientId{1000}, "0");
    CHECK_FALSE(seats.place(ClientId{1000}));
    seats.join(ClientId{1001}, "64");
    CHECK(seats.place(ClientId{1001}));
}
