#include <doctest/doctest.h>

#include "parallel/ranks/ambient_exchange.h"

using namespace lightwalk;

namespace {

constexpr int kMaster = 0, kClient = 1;

AmbientValues values_of(std::uint32_t scene, std::size_t count) {
    return {std::vector<AmbientRecord>(count), scene};
}

AmbientValues news_of(std::uint32_t scene, std::size_t count) {
    return {std::vector<AmbientRecord>(count), scene, AmbientValues::Direction::news};
}

AmbientValues answer_of(AmbientMaster& master, int rank, AmbientValues values) {
    Outbox out;
    master.handle(rank, std::move(values), out);
    REQUIRE(out.messages.size() == 1);
    CHECK(out.messages.front().to == rank);
    const auto& answer = std::get<AmbientValues>(out.messages.front().message);
    CHECK(answer.direction == AmbientValues::Direction::news);
    return answer;
}

}  // namespace

TEST_CASE("ambient values of several scenes: the master forgets those of the scene before") {
    AmbientMaster master(kMaster);
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
    AmbientClient client(kClient, kMaster, 4);
    Outbox out;
    client.offer(values_of(1, 3), out);
    CHECK(out.messages.empty());  // no batch yet
    client.offer(values_of(2, 1), out);
    CHECK(out.messages.empty());
    client.offer(values_of(1, 9), out);
    CHECK(out.messages.empty());
    client.ask(out);
    REQUIRE(out.messages.size() == 1);
    const auto& offer = std::get<AmbientValues>(out.messages[0].message);
    CHECK(offer.records.size() == 1);
    CHECK(offer.scene == 2);
    CHECK(offer.direction == AmbientValues::Direction::offer);
    SUBCASE("the answer is for the cache") {
        client.handle(news_of(2, 2), out);
        CHECK(out.cache.size() == 1);
    }
    SUBCASE("but not one of the scene before") {
        client.handle(news_of(1, 2), out);
        CHECK(out.cache.empty());
    }
    CHECK_FALSE(client.waits_for_answer());
}
