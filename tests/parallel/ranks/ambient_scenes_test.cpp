#include <doctest/doctest.h>

#include "parallel/ranks/roles.h"

using namespace lightwalk;

namespace {

constexpr Address kMaster{0, Role::ambient_master}, kClient{1, Role::ambient_client};

AmbientValues values_of(std::uint32_t scene, std::size_t count) {
    return {std::vector<AmbientRecord>(count), scene};
}

AmbientValues answer_of(AmbientMasterRole& master, int rank, AmbientValues values) {
    Outbox out;
    master.handle({{rank, Role::ambient_client}, kMaster, std::move(values)}, out);
    REQUIRE(out.size() == 1);
    return std::get<AmbientValues>(out.front().message);
}

}  // namespace

TEST_CASE("ambient values of several scenes: the master forgets those of the scene before") {
    AmbientMasterRole master(kMaster);
    CHECK(answer_of(master, 1, values_of(1, 3)).records.empty());
    CHECK(answer_of(master, 2, values_of(1, 0)).records.size() == 3);
    CHECK(answer_of(master, 2, values_of(2, 1)).records.empty());
    CHECK(master.size() == 1);
    CHECK(answer_of(master, 1, values_of(2, 0)).records.size() == 1);
    SUBCASE("and takes none of it that come late") {
        CHECK(answer_of(master, 1, values_of(1, 5)).scene == 2);
        CHECK(master.size() == 1);
    }
}

TEST_CASE("ambient values of several scenes: a client keeps them apart") {
    AmbientClientRole client(kClient, kMaster, 4);
    const Address cache{1, Role::cache};
    Outbox out;
    client.handle({cache, kClient, values_of(1, 3)}, out);
    CHECK(out.empty());  // no batch yet
    client.handle({cache, kClient, values_of(2, 1)}, out);
    CHECK(out.empty());
    client.handle({cache, kClient, values_of(1, 9)}, out);
    CHECK(out.empty());
    client.ask(out);
    REQUIRE(out.size() == 1);
    CHECK(std::get<AmbientValues>(out[0].message).records.size() == 1);
    CHECK(std::get<AmbientValues>(out[0].message).scene == 2);
    out.clear();
    SUBCASE("the answer is for the cache") {
        client.handle({kMaster, kClient, values_of(2, 2)}, out);
        CHECK(out.size() == 1);
    }
    SUBCASE("but not one of the scene before") {
        client.handle({kMaster, kClient, values_of(1, 2)}, out);
        CHECK(out.empty());
    }
    CHECK_FALSE(client.waits_for_answer());
}
