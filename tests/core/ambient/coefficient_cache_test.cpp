#include "core/ambient/coefficient_cache.h"

#include <doctest/doctest.h>

#include <cstring>

#include "core/ambient/ambient_calculation.h"
#include "core/ambient/serial_cache.h"
#include "core/trace/ray_tally.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr std::size_t kQuarters = 4;

/// A coloured room with a window, a table and a half transparent curtain, under a sky of
/// radiance 1.
const std::string kRoom = R"(
void glow sky 0 0 4 1 1 1 0
sky source dome 0 0 4 0 0 1 180
void plastic wall 0 0 5 .6 .5 .4 0 0
void plastic ground 0 0 5 .2 .3 .2 0 0
void glass pane 0 0 3 .9 .8 .7
void trans veil 0 0 7 .6 .6 .5 0 0 .6 .4
ground polygon earth 0 0 12 -20 -20 -.5 20 -20 -.5 20 20 -.5 -20 20 -.5
wall polygon floor 0 0 12 0 0 0 4 0 0 4 5 0 0 5 0
wall polygon ceiling 0 0 12 0 0 3 0 5 3 4 5 3 4 0 3
wall polygon back 0 0 12 0 5 0 4 5 0 4 5 3 0 5 3
wall polygon left 0 0 12 0 0 0 0 5 0 0 5 3 0 0 3
wall polygon right 0 0 12 4 0 0 4 0 3 4 5 3 4 5 0
wall polygon front 0 0 30 0 0 0 0 0 3 4 0 3 4 0 0 1 0 0 1 0 1 3 0 1 3 0 2.5 1 0 2.5 1 0 0
pane polygon window 0 0 12 1 0 1 1 0 2.5 3 0 2.5 3 0 1
wall polygon table 0 0 12 1 2 .7 3 2 .7 3 3 .7 1 3 .7
veil polygon curtain 0 0 12 1 .5 1 1 .5 2.5 2 .5 2.5 2 .5 1
)";

RenderOptions room_options(int bounces) {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = bounces;
    options.ambient_accuracy = 0.3;
    options.ambient_divisions = 256;
    options.ambient_super_samples = 0;
    options.reflection_limit = -10;
    options.weight_limit = 1e-6;
    return options;
}

/// What the four quarters of the sky bring.
class Quarters final : public RayTally {
  public:
    explicit Quarters(const CoefficientCache& cache) : records_(cache) {}
    void add(const Contribution& term) override {
        const std::size_t quarter = (term.direction.x > 0 ? 1 : 0) + (term.direction.y > 0 ? 2 : 0);
        for (std::size_t k = 0; k < 3; ++k)
            sums_[3 * quarter + k] += static_cast<double>(term.coefficient[k]);
    }
    void add_record(std::uint32_t record, const Rgb& coefficient) override {
        records_.add(record, coefficient);
    }
    void take(std::string& bytes) override {
        records_.take(sums_);
        bytes.append(reinterpret_cast<const char*>(sums_.data()), sizeof sums_);
        sums_ = {};
    }
    [[nodiscard]] CoefficientTerms take_terms() override {
        CoefficientTerms terms;
        terms.records = records_.take();
        for (std::uint32_t i = 0; i < kQuarters; ++i)
            terms.columns.push_back({i, rgb(&sums_[std::size_t{3} * i])});
        sums_ = {};
        return terms;
    }
    [[nodiscard]] std::vector<double> take() {
        records_.take(sums_);
        std::vector<double> sums(sums_.begin(), sums_.end());
        sums_ = {};
        return sums;
    }

  private:
    static Rgb rgb(const double* c) {
        return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
    }
    CoefficientSums records_;
    std::array<double, 3 * kQuarters> sums_{};
};

Rgb total(const std::vector<double>& sums) {
    Rgb all;
    for (std::size_t i = 0; i < sums.size(); ++i) all[i % 3] += static_cast<float>(sums[i]);
    return all;
}

void check_same(const Rgb& got, const Rgb& expected) {
    // Sums of some hundred floats in another order.
    for (std::size_t k = 0; k < 3; ++k)
        CHECK(static_cast<double>(got[k]) == within(2e-5, static_cast<double>(expected[k])));
}

AmbientLimits limits_of(const Scene& scene, const RenderOptions& options) {
    const SceneCube cube = scene.cube();
    return ambient_limits(cube.origin, cube.size, options.ambient_accuracy, 128);
}

/// A place on the floor, or the back wall, where a ray of a hemisphere asks.
AmbientPoint asks_at(double x, double y, int level) {
    AmbientPoint point;
    point.query.position = {x, y, 0};
    point.query.normal = point.query.shading_normal = {0, 0, 1};
    point.query.level = level;
    point.query.weight = level == 1 ? 0.5 : 0.25;
    point.history = kPrimary | kAmbientSame;
    return point;
}

/// A room with a cache of coefficients that its rays are told of.
struct KeptRoom {
    explicit KeptRoom(int bounces)
        : scene(kRoom, room_options(bounces)),
          cache(limits_of(scene.scene, scene.tracer.options()), 1),
          tally(cache),
          calculation(scene.tracer) {
        scene.tracer.use_coefficients(&cache);
        calculation.use_coefficients(&cache);
        scene.context.contributions = &tally;
    }
    /// Computes a record and stores it.
    std::optional<AmbientRecord> keep(const AmbientPoint& point) {
        const auto record = calculation.record_at(point, scene.context);
        const CoefficientTerms terms = tally.take_terms();
        if (record) cache.insert(*record, terms);
        return record;
    }

    TestScene scene;
    CoefficientCache cache;
    Quarters tally;
    AmbientCalculation calculation;
};

const auto no_leak = [](const Vec3& /*target*/) { return false; };

}  // namespace

TEST_CASE(
    "coefficients: under a sky of 1 their sum, interpolated, is the ambient value of the plain "
    "cache") {
    KeptRoom kept(2);
    TestScene plain(kRoom, room_options(2));
    SerialCache values(kept.cache.limits());
    plain.tracer.use_ambient_cache(&values);
    AmbientCalculation calculation(plain.tracer);
    calculation.use_cache(&values);
    for (double x = 0.3; x < 4; x += 0.7) {
        for (double y = 0.3; y < 5; y += 0.7) {
            const auto record = kept.keep(asks_at(x, y, 1));
            const auto value = calculation.record_at(asks_at(x, y, 1), plain.context);
            REQUIRE(record.has_value());
            REQUIRE(value.has_value());
            CHECK(record->radius == value->radius);
            CHECK(record->translation == value->translation);
            check_same(record->value, value->value);
            values.insert(*value);
        }
    }
    int served = 0;
    std::vector<RecordShare> shares;
    for (double x = 0.05; x < 4; x += 0.21) {
        AmbientQuery query = asks_at(x, 5 * x / 4, 1).query;
        query.shading_normal = normalize(Vec3{0.2, 0.1, 1});
        const AmbientSum sum = values.lookup(query, no_leak);
        kept.cache.find(query, no_leak, shares);
        CHECK(shares.empty() == (sum.weight <= kEpsilon));
        if (shares.empty()) continue;
        ++served;
        for (const RecordShare& share : shares)
            kept.tally.add_record(share.record,
                                  Rgb::grey(static_cast<float>(share.weight * share.factor)));
        Rgb expected;
        for (std::size_t k = 0; k < 3; ++k)
            expected[k] = static_cast<float>(sum.sum[k] / sum.weight);
        check_same(total(kept.tally.take()), expected);
    }
    CHECK(served > 5);
}

TEST_CASE(
    "coefficients: what a sensor is told adds up to what it sees, through records of records") {
    KeptRoom kept(3);
    for (const int level : {2, 1}) {
        for (double x = 0.3; x < 4; x += 0.7) {
            for (double y = 0.3; y < 5; y += 0.7) {
                AmbientPoint point = asks_at(x, y, level);
                if (level == 2) {  // on the ceiling, which the floor sees
                    point.query.position.z = 3;
                    point.query.normal = point.query.shading_normal = {0, 0, -1};
                }
                CHECK(kept.keep(point).has_value());
            }
        }
    }
    const std::uint64_t before = kept.scene.context.counters.ambient.interpolated;
    CHECK(before > 0);  // records of level 1 saw those of level 2
    for (const Vec3& at : {Vec3{2, 1, 0.8}, Vec3{2, 4, 0.8}, Vec3{1, 2.5, 1.5}}) {
        for (const Vec3& normal : {Vec3{0, 0, 1}, Vec3{0, 0.3, -1}}) {
            const Ray ray = kept.scene.tracer.irradiance(
                at, normal, RandomStream::of_pixel(7, 1, 0, 0), kept.scene.context);
            CHECK(max_component(ray.value) > 0);
            check_same(total(kept.tally.take()), ray.value);
        }
    }
    CHECK(kept.scene.context.counters.ambient.interpolated > before);
}

TEST_CASE("coefficients of a level serve that level alone, other than ambient values") {
    KeptRoom kept(3);
    CHECK(kept.keep(asks_at(2, 2, 1)).has_value());
    CHECK(kept.cache.serves(asks_at(2, 2, 1).query, no_leak));
    CHECK_FALSE(kept.cache.serves(asks_at(2, 2, 2).query, no_leak));
    CHECK(kept.cache.size(1) == 1);
    CHECK(kept.cache.size(2) == 0);
}

TEST_CASE("coefficients: sums go through records of records, however often one is referred to") {
    CoefficientCache cache(ambient_limits({-1, -1, -1}, 4, 0.2, 32), 1);
    AmbientRecord record;
    record.radius = {1, 1};
    record.level = 3;
    cache.insert(record, {{{0, {1, 2, 3}}, {2, {4, 4, 4}}}, {}});
    record.level = 2;
    cache.insert(record, {{{1, {1, 1, 1}}}, {{0, {2, 2, 2}}}});
    cache.insert(record, {{}, {{0, {1, 0, 1}}}});
    record.level = 1;
    cache.insert(record, {{{0, {1, 1, 1}}}, {{2, {1, 1, 1}}, {1, {0.5f, 0.5f, 0.5f}}}});
    cache.insert(record, {{}, {{1, {1, 1, 1}}}});
    CHECK(cache.size(1) == 2);
    CoefficientSums sums(cache);
    // Record 3 counts 10 times, so record 2 does, and record 1 15 times: record 0, 40 times, 30 in
    // green.
    const std::vector<double> expected{10 + 40 * 1, 10 + 30 * 2, 10 + 40 * 3, 15,    15,
                                       15,          40 * 4,      30 * 4,      40 * 4};
    for (int again = 0; again < 2; ++again) {
        sums.add(3, {4, 4, 4});
        sums.add(4, {10, 10, 10});
        sums.add(3, {6, 6, 6});
        std::vector<double> found(9);
        sums.take(found);
        CHECK(found == expected);
    }
    CHECK(sums.take().empty());
}
