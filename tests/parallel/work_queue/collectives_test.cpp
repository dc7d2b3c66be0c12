#include "parallel/ranks/collectives.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace lightwalk;

TEST_CASE("a group's shares come together in the order of its ranks, and are added up") {
    const Topology topology = make_topology(Variant::ranks, 4, false, 1);  // rank 0 does not trace
    Collectives collectives(topology, 2);
    CHECK(collectives.members(Collective::Group::all).size() == 4);
    CHECK(collectives.members(Collective::Group::owners) == std::vector<int>{1, 2});
    CHECK(collectives.members(Collective::Group::workers) == std::vector<int>{1, 2, 3});
    CHECK(collectives.members(Collective::Group::rounds) == std::vector<int>{0, 1, 2, 3});
    Outbox out;
    const auto share = [&](int rank, std::uint32_t round, std::vector<std::string> parts) {
        collectives.handle(rank,
                           {Collective::Group::workers,
                            round,
                            false,
                            std::move(parts),
                            {static_cast<std::uint64_t>(rank), 1}},
                           out);
    };
    const auto one = [](int rank) { return std::vector{std::to_string(rank)}; };
    // Ranks of the next round may be sooner than those of the one before.
    for (const int rank : {3, 1}) share(rank, 0, one(rank));
    share(1, 1, one(1));
    CHECK(out.messages.empty());
    share(2, 0, one(2));
    REQUIRE(out.messages.size() == 3);
    CHECK(std::get<Collective>(out.messages[0].message).parts ==
          std::vector<std::string>{"1", "2", "3"});
    out = {};
    for (const int rank : {2, 3}) share(rank, 1, one(rank));
    REQUIRE(out.messages.size() == 3);
    CHECK(std::get<Collective>(out.messages[2].message).numbers ==
          std::vector<std::uint64_t>{6, 3});
    CHECK_THROWS_AS(share(0, 2, one(0)), InputError);  // no member
    CHECK_THROWS_AS(share(1, 2, {}), InputError);
    CHECK_THROWS_AS(share(1, 2, {"two", "parts"}), InputError);
}
