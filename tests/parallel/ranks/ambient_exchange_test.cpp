#include "parallel/ranks/ambient_exchange.h"

#include <doctest/doctest.h>

#include <utility>
#include <vector>

#include "tests/parallel/ambient_values.h"

using namespace lightwalk;
using lightwalk::test::record_at;

namespace {

constexpr int kMaster = 0, kClient = 1;

AmbientValues values_of(std::size_t count) {
    return {std::vector<AmbientRecord>(count)};
}

AmbientValues news_of(std::size_t count) {
    return {std::vector<AmbientRecord>(count), AmbientValues::Direction::news};
}

AmbientValues answer_of(AmbientMaster& master, int rank, const AmbientValues& values) {
    Outbox out;
    master.handle(rank, values, out);
    REQUIRE(out.messages.size() == 1);
    CHECK(out.messages.front().to == rank);
    const auto& answer = std::get<AmbientValues>(out.messages.front().message);
    CHECK(answer.direction == AmbientValues::Direction::news);
    return answer;
}

/// Keeps what it is given.
class ListingCache final : public AmbientCache {
  public:
    std::vector<AmbientRecord> records;
    [[nodiscard]] const AmbientLimits& limits() const override { return limits_; }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery&, LeakTest) const override { return {}; }
    void insert(const AmbientRecord& record) override { records.push_back(record); }
    [[nodiscard]] AmbientLogMean log_mean() const override { return {}; }

  private:
    AmbientLimits limits_;
};

}  // namespace

TEST_CASE("ambient values: the master passes each to who has not told or heard it") {
    AmbientMaster master(kMaster);
    CHECK(answer_of(master, 1, values_of(3)).records.empty());
    CHECK(answer_of(master, 2, values_of(1)).records.size() == 3);
    CHECK(answer_of(master, 2, values_of(0)).records.empty());
    CHECK(answer_of(master, 1, values_of(0)).records.size() == 1);
    CHECK(master.size() == 4);
    SUBCASE("and forgets those of a scene that is done with") {
        master.clear();
        CHECK(master.size() == 0);
        CHECK(answer_of(master, 2, values_of(1)).records.empty());
        CHECK(answer_of(master, 1, values_of(0)).records.size() == 1);
    }
}

TEST_CASE("ambient values: what light groups add to them goes with them") {
    const std::vector<Rgb> groups{{1, 2, 3}, {4, 5, 6}};
    std::vector<AmbientValues> sent;
    SharedCache shared(2, [&](AmbientValues values) { sent.push_back(std::move(values)); });
    for (int i = 0; i < 2; ++i) shared.stored(record_at(static_cast<float>(i)), groups);
    REQUIRE(sent.size() == 1);
    AmbientMaster master(kMaster);
    CHECK(answer_of(master, 1, sent[0]).groups.empty());
    const AmbientValues news = answer_of(master, 2, values_of(0));
    REQUIRE(news.records.size() == 2);
    for (const std::size_t i : {0, 1})
        CHECK(std::vector(news.groups_of(i).begin(), news.groups_of(i).end()) == groups);
}

TEST_CASE("ambient values: a client has one offer out at a time") {
    AmbientClient client(kClient, kMaster, 4);
    Outbox out;
    const auto offered = [&](std::size_t message) {
        return std::get<AmbientValues>(out.messages.at(message).message).records.size();
    };
    client.offer(values_of(3), out);
    CHECK(out.messages.empty());  // no batch yet
    CHECK(client.is_flushed());
    client.offer(values_of(2), out);
    REQUIRE(out.messages.size() == 1);
    CHECK(offered(0) == 5);
    CHECK_FALSE(client.is_flushed());
    client.offer(values_of(9), out);
    CHECK(out.messages.size() == 1);
    client.handle(news_of(2), out);  // the answer is for the cache
    CHECK(out.cache.size() == 1);
    REQUIRE(out.messages.size() == 2);  // by now there was another batch
    CHECK(offered(1) == 9);
    SUBCASE("whose answer may be the last") {
        client.handle(news_of(0), out);
        CHECK(client.is_flushed());
        CHECK(out.cache.size() == 1);
    }
    SUBCASE("and a question that comes meanwhile is asked after it") {
        client.offer(values_of(1), out);
        client.ask(out);
        CHECK(out.messages.size() == 2);
        client.handle(news_of(1), out);
        CHECK_FALSE(client.is_flushed());
        REQUIRE(out.messages.size() == 3);
        CHECK(offered(2) == 1);
        client.handle(news_of(1), out);
        CHECK(client.is_flushed());
    }
}

TEST_CASE("new ambient values go out by the batch, and what makes no batch is handed over") {
    std::vector<std::size_t> batches;
    SharedCache shared(
        3, [&](const AmbientValues& values) { batches.push_back(values.records.size()); });
    for (int i = 0; i < 7; ++i) shared.stored(record_at(static_cast<float>(i)), {});
    CHECK(batches == std::vector<std::size_t>{3, 3});
    const std::vector<AmbientRecord> rest = shared.unsent().records;
    REQUIRE(rest.size() == 1);
    CHECK(rest[0].position[0] == 6);
    CHECK(shared.unsent().records.empty());
}

TEST_CASE("ambient values of others come into the cache while it is shared, and do not go back") {
    SharedCache shared(1, [](const AmbientValues&) { FAIL("it was sent back"); });
    ListingCache values;
    PublishedCache cache(values);
    shared.merge(news_of(2));  // nobody's yet
    CHECK_FALSE(shared.is_open());
    shared.open(cache);
    CHECK(shared.is_open());
    shared.merge(news_of(3));
    CHECK(values.records.size() == 3);
    shared.close();
    shared.merge(news_of(4));
    CHECK(values.records.size() == 3);
}

TEST_CASE("ambient values: those of a scene before reach nobody once it has changed") {
    constexpr std::uint64_t kNew = 7;
    const auto of_scene = [](AmbientValues values, std::uint64_t scene) {
        values.scene = scene;
        return values;
    };
    AmbientMaster master(kMaster);
    CHECK(answer_of(master, 1, values_of(3)).records.empty());
    CHECK(answer_of(master, 2, of_scene(values_of(1), kNew)).records.empty());
    CHECK(master.size() == 1);
    // Rank 1 has not heard of it: what it offers is too late, and it is not told what it cannot
    // use.
    const AmbientValues late = answer_of(master, 1, values_of(2));
    CHECK(late.records.empty());
    CHECK(late.scene == 0);
    CHECK(master.size() == 1);
    const AmbientValues news = answer_of(master, 1, of_scene(values_of(0), kNew));
    CHECK(news.records.size() == 1);
    CHECK(news.scene == kNew);
}

TEST_CASE("ambient values: a cache takes those of its own scene, and tells of its own ones") {
    std::vector<AmbientValues> sent;
    SharedCache shared(2, [&](AmbientValues values) { sent.push_back(std::move(values)); });
    ListingCache old_values, new_values;
    PublishedCache before(old_values), after(new_values);
    shared.open(before);
    shared.stored(record_at(1), {});
    shared.open(after, 7);
    shared.merge(news_of(2));
    CHECK(old_values.records.empty());
    CHECK(new_values.records.empty());
    AmbientValues news = news_of(1);
    news.scene = 7;
    shared.merge(news);
    CHECK(new_values.records.size() == 1);
    for (int i = 0; i < 2; ++i) shared.stored(record_at(2), {});
    REQUIRE(sent.size() == 1);
    CHECK(sent[0].scene == 7);
    CHECK(sent[0].records.size() == 2);  // none of before
    CHECK(shared.unsent().scene == 7);
}

TEST_CASE("ambient values: a client forgets what it had not offered of the scene before") {
    AmbientClient client(kClient, kMaster, 4);
    Outbox out;
    AmbientValues fresh = values_of(1);
    fresh.scene = 7;
    client.offer(values_of(3), out);
    client.offer(fresh, out);
    client.offer(values_of(2), out);  // late
    client.ask(out);
    REQUIRE(out.messages.size() == 1);
    const auto& offered = std::get<AmbientValues>(out.messages[0].message);
    CHECK(offered.scene == 7);
    CHECK(offered.records.size() == 1);
    client.handle(AmbientValues{{}, AmbientValues::Direction::news, {}, 7}, out);
    client.ask(out);  // having nothing new, it still says of which scene it is
    CHECK(std::get<AmbientValues>(out.messages.at(1).message).scene == 7);
}
