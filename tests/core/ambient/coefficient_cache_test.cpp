#include "core/ambient/coefficient_cache.h"

#include <doctest/doctest.h>

#include <cstring>

#include "core/ambient/ambient_cache.h"
#include "core/ambient/coefficient_calculation.h"
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
    [[nodiscard]] std::vector<CoefficientTerm> take_terms() override {
        std::vector<CoefficientTerm> terms;
        for (std::uint32_t i = 0; i < kQuarters; ++i)
            terms.push_back({i, rgb(&sums_[std::size_t{3} * i])});
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
AmbientPoint asks_at(double x, double y) {
    AmbientPoint point;
    point.query.position = {x, y, 0};
    point.query.normal = point.query.shading_normal = {0, 0, 1};
    point.query.level = 1;
    point.query.weight = 0.5;
    point.history = kPrimary | kAmbientSame;
    return point;
}

/// A room with a cache of coefficients that its rays are told of.
struct KeptRoom {
    explicit KeptRoom(int bounces)
        : scene(kRoom, room_options(bounces)),
          cache(limits_of(scene.scene, scene.tracer.options()), 1),
          tally(cache),
          calculation(scene.tracer, cache) {
        scene.tracer.use_coefficients(&cache);
        scene.context.contributions = &tally;
    }
    struct Made {
        std::optional<CoefficientRecord> record;
        std::vector<CoefficientTerm> terms;
    };
    Made make(const AmbientPoint& point) {
        const auto reach = calculation.reach_at(point);
        if (!reach) return {};
        Made made;
        made.record = calculation.record_at(point, *reach, scene.context);
        made.terms = tally.take_terms();
        return made;
    }
    /// Computes a record and stores it.
    std::optional<CoefficientRecord> keep(const AmbientPoint& point) {
        const Made made = make(point);
        if (made.record) cache.insert(*made.record, made.terms);
        return made.record;
    }

    TestScene scene;
    CoefficientCache cache;
    Quarters tally;
    CoefficientCalculation calculation;
};

}  // namespace

TEST_CASE("coefficients: the terms of a record add up to its irradiance") {
    KeptRoom kept(3);
    for (double x = 0.3; x < 4; x += 0.7) {
        for (double y = 0.3; y < 5; y += 0.7) {
            const KeptRoom::Made made = kept.make(asks_at(x, y));
            REQUIRE(made.record.has_value());
            Rgb sum;
            for (const CoefficientTerm& term : made.terms) sum += term.coefficient;
            check_same(sum, made.record->value);
        }
    }
}

TEST_CASE("coefficients: records do not reach through walls") {
    KeptRoom kept(2);
    for (double y = -0.2; y > -6; y -= 0.4) {  // under the sky
        AmbientPoint point = asks_at(2, y);
        point.query.position.z = -0.5;
        CHECK_FALSE(kept.keep(point).has_value());
    }
    for (double x = 0.1; x < 2; x += 0.3) {
        const auto record = kept.keep(asks_at(x, 4));
        REQUIRE(record.has_value());
        CHECK(record->reach <= std::max(x, kept.cache.least_reach()));
    }
}

TEST_CASE("coefficients: how far a record reaches does not depend on light") {
    KeptRoom kept(3);
    TestScene dark(kRoom.substr(kRoom.find("void plastic wall")), room_options(3));
    const CoefficientCache cache(kept.cache.limits(), 1);
    const CoefficientCalculation calculation(dark.tracer, cache);
    for (double x = 0.3; x < 4; x += 0.7) {
        const auto reach = calculation.reach_at(asks_at(x, 4));
        REQUIRE(reach.has_value());
        CHECK(reach == kept.calculation.reach_at(asks_at(x, 4)));
    }
}

TEST_CASE("coefficients: what a sensor is told adds up to what it sees, with records and without") {
    KeptRoom kept(3);
    int kept_records = 0;
    for (double x = 0.3; x < 4; x += 0.7) {
        for (double y = 0.3; y < 5; y += 0.7) {
            AmbientPoint ceiling = asks_at(x, y);
            ceiling.query.position.z = 3;
            ceiling.query.normal = ceiling.query.shading_normal = {0, 0, -1};
            kept_records += kept.keep(ceiling) ? 1 : 0;
            kept_records += kept.keep(asks_at(x, y)) ? 1 : 0;
        }
    }
    CHECK(kept_records > 50);
    const std::uint64_t before = kept.scene.context.counters.ambient.interpolated;
    for (const Vec3& at : {Vec3{2, 1, 0.8}, Vec3{2, 4, 0.8}, Vec3{1, 2.5, 1.5}}) {
        for (const Vec3& normal : {Vec3{0, 0, 1}, Vec3{0, 0.3, -1}}) {
            const Ray ray = kept.scene.tracer.irradiance(
                at, normal, RandomStream::of_pixel(7, 1, 0, 0), kept.scene.context);
            CHECK(max_component(ray.value) > 0);
            check_same(total(kept.tally.take()), ray.value);
        }
    }
    CHECK(kept.scene.context.counters.ambient.interpolated > before + 100);
}

TEST_CASE("coefficients: sums are those of the records' terms, each as often as it was added") {
    CoefficientCache cache(ambient_limits({-1, -1, -1}, 4, 0.2, 32), 1);
    const CoefficientRecord record{{}, {0, 0, 1}, 1, {}};
    using Terms = std::vector<CoefficientTerm>;
    cache.insert(record, Terms{{0, {1, 2, 3}}, {2, {4, 4, 4}}});
    cache.insert(record, Terms{});
    cache.insert(record, Terms{{1, {1, 1, 1}}, {0, {0, 1, 0}}});
    CHECK(cache.size() == 3);
    CoefficientSums sums(cache);
    for (int again = 0; again < 2; ++again) {
        sums.add(2, {4, 4, 4});
        sums.add(0, {10, 0, 10});
        sums.add(1, {1, 1, 1});
        sums.add(2, {6, 6, 6});
        std::vector<double> found(9);
        sums.take(found);
        CHECK(found == std::vector<double>{10, 10, 30, 10, 10, 10, 40, 0, 40});
    }
}
