#include "parallel/walk/grid_illuminance.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::Silence;
using lightwalk::test::TestScene;

namespace {

/// A square level grid of side x side points around the origin, all of which count.
MeasuringGrid level_grid(int side, double apart) {
    MeasuringGrid grid;
    grid.columns = grid.rows = side;
    grid.across = {apart, 0, 0};
    grid.along = {0, apart, 0};
    grid.normal = {0, 0, 1};
    grid.origin = -0.5 * (side - 1) * (grid.across + grid.along);
    grid.counts.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 1);
    return grid;
}

/// Measures in a scene.
struct Meter {
    Meter(const std::string& text, const RenderOptions& options, MeasuringGrid grid,
          ExecutorKind kind = kDefaultExecutor)
        : scene(text, options), executor(make_executor(kind, 2)), light(std::move(grid)) {}
    bool step(double seconds = 0) {
        return light.step(scene.tracer, contexts, seconds, *executor, stop);
    }
    std::vector<float> finished() {
        while (step(1)) continue;
        return light.values();
    }

    Silence warnings;
    TestScene scene;
    std::unique_ptr<Executor> executor;
    WorkerContexts contexts{scene.tracer, warnings, executor->concurrency()};
    GridIlluminance light;
    StopFlag stop;
};

// A lamp so small that it is a point, 2.5 m above the middle.
constexpr double kLampHeight = 2.5, kLampRadius = 0.005, kLampRadiance = 1e6;
const std::string kPointLamp =
    "void light lamp 0 0 3 1e6 1e6 1e6\nlamp sphere bulb 0 0 4 0 0 2.5 .005\n";

}  // namespace

TEST_CASE(
    "grid illuminance: under a uniform sky it is the same everywhere, pi times the luminance") {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = 1;
    options.ambient_accuracy = 0;
    options.ambient_divisions = 64;
    Meter meter("void glow sky 0 0 4 1 1 1 0\nsky source dome 0 0 4 0 0 1 180\n", options,
                level_grid(9, 1));
    const std::vector<float> lux = meter.finished();
    REQUIRE(lux.size() == 81);
    for (const float value : lux) CHECK(value == doctest::Approx(179 * kPi).epsilon(0.001));
}

TEST_CASE("grid illuminance: a point lamp's is I cos^3 / h^2 at each point") {
    Meter meter(kPointLamp, TestScene::exact(), level_grid(21, 0.5));
    const std::vector<float> lux = meter.finished();
    const double intensity = 179 * kLampRadiance * kPi * kLampRadius * kLampRadius;  // [cd]
    const MeasuringGrid& grid = meter.light.grid();
    for (int y = 0; y < 21; ++y)
        for (int x = 0; x < 21; ++x) {
            const Vec3 p = grid.point(x, y);
            const double cosine = kLampHeight / std::hypot(p.x, p.y, kLampHeight);
            const double wanted = intensity * std::pow(cosine, 3) / (kLampHeight * kLampHeight);
            // The sensor stands .1 mm higher, and the lamp is not quite a point.
            CHECK(lux[static_cast<std::size_t>(21 * y + x)] ==
                  doctest::Approx(wanted).epsilon(0.001));
        }
}

TEST_CASE(
    "grid illuminance: it comes coarse to fine, and each grid's values are those of its points") {
    MeasuringGrid grid = level_grid(10, 0.5);
    grid.counts[0] = grid.counts[44] = 0;  // 44 is the point 4, 4
    Meter meter(kPointLamp, TestScene::exact(), grid);
    const std::vector<float> all = Meter(kPointLamp, TestScene::exact(), grid).finished();
    CHECK(meter.light.stride() == 0);
    CHECK(meter.light.values().empty());
    std::vector<int> strides;
    double share = 0;
    bool more = true;
    while (more) {
        more = meter.step();
        CHECK(meter.light.share() > share);
        share = meter.light.share();
        const int stride = meter.light.stride();
        if (strides.empty() || strides.back() != stride) strides.push_back(stride);
        const std::vector<float> some = meter.light.values();
        if (stride == 0) continue;
        const int side = (10 + stride - 1) / stride;
        REQUIRE(some.size() == static_cast<std::size_t>(side * side));
        CHECK(std::isnan(some[0]));
        // No light here depends on chance.
        CHECK(some[1] == doctest::Approx(all[static_cast<std::size_t>(stride)]).epsilon(1e-6));
    }
    CHECK(share == 1);
    CHECK_FALSE(meter.step());
    CHECK(strides.back() == 1);
    CHECK(std::is_sorted(strides.rbegin(), strides.rend() - (strides.front() == 0 ? 1 : 0)));
    CHECK(std::count(strides.begin(), strides.end(), 4) == 1);
    CHECK(std::isnan(all[44]));
    CHECK(std::count_if(all.begin(), all.end(), [](float x) { return std::isnan(x); }) == 2);
}

TEST_CASE(
    "grid illuminance: whoever computes it, and whatever stops it on the way, it is the same") {
    const std::string panel =
        "void light lamp 0 0 3 5 5 5\nlamp polygon p 0 0 12 0 0 2 0 1 2 1 1 2 1 0 2\n";
    RenderOptions options = TestScene::exact();
    options.source_jitter = 1;
    Meter serial(panel, options, level_grid(6, 0.5), ExecutorKind::serial);
    const std::vector<float> wanted = serial.finished();
    Meter threads(panel, options, level_grid(6, 0.5));
    CHECK(threads.step());
    threads.stop.request();
    const double share = threads.light.share();
    CHECK(threads.step());
    CHECK(threads.light.share() == share);
    threads.stop.clear();
    CHECK(threads.finished() == wanted);
    CHECK(wanted[0] > 0);
}

TEST_CASE("grid illuminance: where no point counts there is nothing to measure") {
    MeasuringGrid grid = level_grid(4, 1);
    grid.counts.assign(16, 0);
    Meter meter(kPointLamp, TestScene::exact(), grid);
    CHECK_FALSE(meter.step());
    CHECK(meter.light.share() == 1);
}
