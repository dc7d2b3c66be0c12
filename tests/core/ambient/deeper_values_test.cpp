// Ambient values of deeper levels have fewer samples than Radiance's, and what is seen by way of
// them has the same mean.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/ambient/serial_cache.h"
#include "tests/one_thread.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

/// A room of grey walls; a square in it glows upwards, and is no direct light: all that the floor
/// gets comes by way of the ceiling and of walls.
const char* const kRoom =
    "void plastic grey 0 0 5 .6 .6 .6 0 0 void glow shine 0 0 4 9 9 9 0 "
    "grey polygon floor 0 0 12 0 0 0  4 0 0  4 4 0  0 4 0 "
    "grey polygon ceiling 0 0 12 0 0 3  0 4 3  4 4 3  4 0 3 "
    "grey polygon west 0 0 12 0 0 0  0 4 0  0 4 3  0 0 3 "
    "grey polygon east 0 0 12 4 0 0  4 0 3  4 4 3  4 4 0 "
    "grey polygon south 0 0 12 0 0 0  0 0 3  4 0 3  4 0 0 "
    "grey polygon north 0 0 12 0 4 0  4 4 0  4 4 3  0 4 3 "
    "shine polygon square 0 0 12 1 1 2  3 1 2  3 3 2  1 3 2 ";

/// A cache that remembers what it was given.
class RememberingCache final : public AmbientCache {
  public:
    explicit RememberingCache(const AmbientLimits& limits) : cache_(limits) {}
    [[nodiscard]] const AmbientLimits& limits() const override { return cache_.limits(); }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override {
        return cache_.lookup(query, leaks);
    }
    void insert(const AmbientRecord& record) override {
        records.push_back(record);
        cache_.insert(record);
    }
    [[nodiscard]] AmbientLogMean log_mean() const override { return cache_.log_mean(); }
    std::vector<AmbientRecord> records;

  private:
    SerialCache cache_;
};

RenderOptions two_bounces(double accuracy, int divisions, std::uint64_t seed) {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = 2;
    options.ambient_accuracy = accuracy;
    options.ambient_divisions = divisions;
    options.ambient_super_samples = 0;
    options.weight_limit = 1e-6;
    options.seed = seed;
    return options;
}

struct Mean {
    double value = 0, error = 0;  ///< error: standard error
};
template <class Sample>
Mean mean_of(int count, const Sample& sample) {
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
        const double value = sample(i);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / count;
    return {mean, std::sqrt((squares / count - mean * mean) / (count - 1))};
}

const Vec3 kEye{2.8, 2.6, 1.5}, kDown{0.1, 0.05, -1};

/// What the eye sees of the floor, from an empty cache.
double seen(RememberingCache& cache, TestScene& scene) {
    scene.tracer.use_ambient_cache(&cache);
    const auto value = static_cast<double>(scene.trace(kEye, kDown).value.g);
    scene.tracer.use_ambient_cache(nullptr);
    return value;
}

RememberingCache empty_cache(const TestScene& scene, double accuracy) {
    const SceneCube cube = scene.scene.cube();
    return RememberingCache(ambient_limits(cube.origin, cube.size, accuracy, 64));
}

}  // namespace

TEST_CASE("deeper ambient values: the second level has an eighth of the first one's samples") {
    TestScene scene(kRoom, two_bounces(0.2, 1024, 1));
    RememberingCache cache = empty_cache(scene, 0.2);
    (void)seen(cache, scene);
    const std::size_t deeper = cache.records.size() - 1;
    REQUIRE(deeper > 1);
    CHECK(cache.records.back().level == 0);
    for (std::size_t i = 0; i < deeper; ++i) {
        CHECK(cache.records[i].level == 1);
        CHECK(cache.records[i].weight == 0.5f);  // they reach as far as Radiance's
    }
    // The eye's ray, 32 x 32 rays of the first level, 11 x 11 of each value of the second.
    CHECK(scene.context.counters.rays.total() == 1 + 1024 + 121 * deeper);
}

TEST_CASE("deeper ambient values: light that comes by way of them has the mean of plain sampling" *
          about_numbers) {
    TestScene plain(kRoom, two_bounces(0, 1024, 1));
    const Mean expected = mean_of(1000, [&](int i) {
        return static_cast<double>(plain.trace(kEye, kDown, static_cast<std::uint32_t>(i)).value.g);
    });
    const Mean found = mean_of(80, [&](int i) {
        TestScene scene(kRoom, two_bounces(0.1, 256, static_cast<std::uint64_t>(i)));
        RememberingCache cache = empty_cache(scene, 0.1);
        return seen(cache, scene);
    });
    CAPTURE(expected.value);
    CAPTURE(expected.error);
    CAPTURE(found.value);
    CAPTURE(found.error);
    const double error = std::hypot(expected.error, found.error);
    REQUIRE(error < 0.01 * expected.value);
    // Half a per cent for interpolation.
    CHECK(std::abs(found.value - expected.value) < 4 * error + 0.005 * expected.value);
}

}  // namespace lightwalk::test
