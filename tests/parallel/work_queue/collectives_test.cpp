#include "parallel/ranks/collectives.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace lightwalk;

TEST_CASE("a group's shares come together in the order of its ranks, and are added up") {
    const Topology topology = make_topology(Variant::ranks, 4, false, 1);  // rank 0 does not trace
    Collectives collectives(topology, 2);
    CHECK(collectives.members(Collective::Group::all).size() == 4);
    CHECK(collectives.members(Collective::Group::owners) == std::vector<int>{1, 2});
    Outbox out;
    const auto share = [&](int rank, Collective::Operation operation, std::uint32_t round) {
        collectives.handle(rank,
                           {Collective::Group::workers,
                            operation,
                            round,
                            false,
                            {std::to_string(rank)},
                            {static_cast<std::uint64_t>(rank), 1}},
                           out);
    };
    // Ranks of the next round may be sooner than those of the one before.
    for (const int rank : {3, 1}) share(rank, Collective::Operation::gather, 0);
    share(1, Collective::Operation::sum, 1);
    CHECK(out.messages.empty());
    share(2, Collective::Operation::gather, 0);
    REQUIRE(out.messages.size() == 3);
    CHECK(std::get<Collective>(out.messages[0].message).parts ==
          std::vector<std::string>{"1", "2", "3"});
    out = {};
    for (const int rank : {2, 3}) share(rank, Collective::Operation::sum, 1);
    REQUIRE(out.messages.size() == 3);
    CHECK(std::get<Collective>(out.messages[2].message).numbers ==
          std::vector<std::uint64_t>{6, 3});
    CHECK_THROWS_AS(share(0, Collective::Operation::gather, 2), InputError);  // no member
}
