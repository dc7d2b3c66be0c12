#include "parallel/coefficient_rounds.h"

#include <doctest/doctest.h>

#include <array>
#include <memory>
#include <thread>
#include <vector>

#include "core/ambient/ambient_cache.h"
#include "parallel/ray_list.h"
#include "tests/parallel/meeting.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void glow sky 0 0 4 1 1 1 0
sky source dome 0 0 4 0 0 1 180
void plastic wall 0 0 5 .6 .5 .4 0 0
wall polygon floor 0 0 12 0 0 0 4 0 0 4 5 0 0 5 0
wall polygon ceiling 0 0 12 0 0 3 0 5 3 4 5 3 4 0 3
wall polygon back 0 0 12 0 5 0 4 5 0 4 5 3 0 5 3
wall polygon left 0 0 12 0 0 0 0 5 0 0 5 3 0 0 3
wall polygon table 0 0 12 1 2 .7 3 2 .7 3 3 .7 1 3 .7
)";

RenderOptions room_options() {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = 3;
    options.ambient_accuracy = 0.3;
    options.ambient_divisions = 100;
    options.ambient_super_samples = 0;
    options.reflection_limit = -10;
    options.weight_limit = 1e-4;
    return options;
}

/// What the sky's halves bring.
class Halves final : public RayTally {
  public:
    explicit Halves(const CoefficientCache& cache) : records_(cache) {}
    void add(const Contribution& term) override {
        for (std::size_t k = 0; k < 3; ++k)
            sums_[(term.direction.x > 0 ? 3 : 0) + k] += static_cast<double>(term.coefficient[k]);
        ++told;
    }
    void add_record(std::uint32_t record, const Rgb& coefficient) override {
        records_.add(record, coefficient);
        ++told;
    }
    void take(std::string& bytes) override {
        records_.take(sums_);
        bytes.append(reinterpret_cast<const char*>(sums_.data()), sizeof sums_);
        sums_ = {};
    }
    [[nodiscard]] std::vector<CoefficientTerm> take_terms() override {
        std::vector<CoefficientTerm> terms;
        for (std::uint32_t i = 0; i < 2; ++i)
            terms.push_back({i, {static_cast<float>(sums_[std::size_t{3} * i]), 0, 0}});
        sums_ = {};
        return terms;
    }
    int told = 0;

  private:
    CoefficientSums records_;
    std::array<double, 6> sums_{};
};

struct KeptRoom {
    explicit KeptRoom(int workers, Group* group = nullptr)
        : scene(kRoom, room_options()),
          cache(ambient_limits(scene.scene.cube().origin, scene.scene.cube().size, 0.3, 64), 1),
          executor(make_executor(kDefaultExecutor, workers)),
          contexts(scene.tracer, scene.warnings, executor->concurrency()) {
        scene.tracer.use_coefficients(&cache);
        std::vector<RayTally*> all;
        for (int w = 0; w < contexts.size(); ++w) {
            tallies.push_back(std::make_unique<Halves>(cache));
            contexts[w].contributions = tallies.back().get();
            all.push_back(tallies.back().get());
        }
        rounds = std::make_unique<CoefficientRounds>(scene.tracer, cache, *executor, contexts,
                                                     std::move(all),
                                                     group != nullptr ? *group : alone, stop);
        for (double x = 0.4; x < 4; x += 0.8)
            for (double y = 0.4; y < 5; y += 0.8) rays.push_back({{x, y, 1}, {0, 0, 1}});
    }
    void trace() { trace(0, rays.size()); }
    void trace(std::size_t begin, std::size_t end) {
        trace_ray_list(scene.tracer, contexts, std::span(rays).subspan(begin, end - begin), begin,
                       {.sensor = true}, *executor, 1,
                       [](std::size_t, int, const Ray&, const Hit&) {});
    }

    TestScene scene;
    CoefficientCache cache;
    std::unique_ptr<Executor> executor;
    WorkerContexts contexts;
    std::vector<std::unique_ptr<Halves>> tallies;
    StopFlag stop;
    GroupOfOne alone;
    std::unique_ptr<CoefficientRounds> rounds;
    std::vector<RayQuery> rays;
};

bool same(std::span<const CoefficientTerm> a, std::span<const CoefficientTerm> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        return x.column == y.column && x.coefficient == y.coefficient;
    });
}

}  // namespace

TEST_CASE("rounds of coefficients: the same records, to the bit, by processes that share them") {
    KeptRoom alone(2);
    REQUIRE(alone.rounds->fill([&] { alone.trace(); }));
    for (const int count : {2, 3}) {
        CAPTURE(count);
        Meeting meeting(count);
        std::vector<std::unique_ptr<MeetingExchange>> exchanges;
        std::vector<std::unique_ptr<KeptRoom>> rooms;
        std::vector<std::thread> threads;
        for (int i = 0; i < count; ++i) {
            exchanges.push_back(std::make_unique<MeetingExchange>(meeting, i, count));
            rooms.push_back(std::make_unique<KeptRoom>(1, exchanges.back().get()));
        }
        for (int i = 0; i < count; ++i) {
            threads.emplace_back([&, i] {
                KeptRoom& room = *rooms[static_cast<std::size_t>(i)];
                const auto n = static_cast<std::size_t>(count), k = static_cast<std::size_t>(i);
                const std::size_t all = room.rays.size();
                CHECK(room.rounds->fill([&] { room.trace(all * k / n, all * (k + 1) / n); }));
            });
        }
        for (std::thread& thread : threads) thread.join();
        for (const auto& room : rooms) {
            REQUIRE(room->cache.size() == alone.cache.size());
            for (std::uint32_t i = 0; i < alone.cache.size(); ++i) {
                CHECK(same(room->cache.terms(i), alone.cache.terms(i)));
                CHECK(room->cache.value(i) == alone.cache.value(i));
            }
        }
    }
}

TEST_CASE("rounds of coefficients: where one process is to stop, all do") {
    Meeting meeting(2);
    MeetingExchange first(meeting, 0, 2), second(meeting, 1, 2);
    KeptRoom one(1, &first), other(1, &second);
    other.stop.request();
    std::thread thread([&] { CHECK_FALSE(one.rounds->fill([&] { one.trace(); })); });
    CHECK_FALSE(other.rounds->fill([] {}));
    thread.join();
    CHECK(one.cache.size() == 0);
}

TEST_CASE("rounds of coefficients: the same records, to the bit, by any number of workers") {
    KeptRoom one(1), three(3);
    (void)one.rounds->fill([&] { one.trace(); });
    (void)three.rounds->fill([&] { three.trace(); });
    CHECK(one.cache.size() > 20);
    REQUIRE(one.cache.size() == three.cache.size());
    for (std::uint32_t i = 0; i < one.cache.size(); ++i) {
        CAPTURE(i);
        CHECK(same(one.cache.terms(i), three.cache.terms(i)));
        CHECK(one.cache.value(i) == three.cache.value(i));
    }
}

TEST_CASE("rounds of coefficients: looking tells nobody, and what was found is not missing again") {
    KeptRoom room(2);
    std::vector<RayQuery> all;
    all.swap(room.rays);
    (void)room.rounds->fill([&] { room.trace(); });
    CHECK(room.cache.size() == 0);  // no ray asked
    all.swap(room.rays);
    (void)room.rounds->fill([&] {
        room.trace();
        for (const auto& tally : room.tallies) CHECK(tally->told == 0);
    });
    const std::size_t first = room.cache.size();
    CHECK(first > 30);
    (void)room.rounds->fill([&] { room.trace(); });
    CHECK(room.cache.size() == first);
}

TEST_CASE("rounds of coefficients end at a stop") {
    KeptRoom room(2);
    room.stop.request();
    (void)room.rounds->fill([&] { room.trace(); });
    CHECK(room.cache.size() == 0);
}
