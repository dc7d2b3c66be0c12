// Direct light where a pixel has many samples: for each a few of many lights stand for all.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "core/light/light_sources.h"
#include "tests/core/light/lamps_over_floor.h"
#include "tests/one_thread.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kLamps = lamps_over_floor() + "lamp cylinder tube 0 0 7 2 -1 1.2  2 1 1.2  .02\n";

RenderOptions with_lights(int lights, double jitter = 0) {
    RenderOptions o = TestScene::exact();
    o.source_subdivision = 0.2;
    o.source_jitter = jitter;
    o.specular_threshold = 1;  // no further rays
    o.sample_lights = lights;
    return o;
}

double seen_on_floor(TestScene& scene, double x, double y, const RandomStream& random) {
    Ray ray = scene.tracer.primary({x, y, 0.9}, {0.1, 0.2, -1}, 0, random);
    scene.tracer.trace(ray, scene.context);
    return static_cast<double>(brightness(ray.value));
}

struct Average {
    double value = 0, deviation = 0;  ///< the latter of the mean
};

template <class Draw>
Average average_of(int count, Draw draw) {
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
        const double value = draw(static_cast<std::uint32_t>(i));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

constexpr std::array<std::pair<double, double>, 4> kFloorPlaces{
    {{-1.5, -1.5}, {0.7, 0.3}, {2.5, 2.0}, {-2.9, 0.1}}};

}  // namespace

TEST_CASE("a few lights bring to the samples of a pixel in the mean what all bring" *
          about_numbers) {
    TestScene all(kLamps, with_lights(0), striped_files());
    for (const int lights : {1, 2, 4}) {
        TestScene few(kLamps, with_lights(lights), striped_files());
        Average together;
        for (const auto& [x, y] : kFloorPlaces) {
            CAPTURE(lights);
            CAPTURE(x);
            const double expected = seen_on_floor(all, x, y, RandomStream(1));
            REQUIRE(expected > 0);
            const Average found = average_of(lights == 1 ? 60000 : 20000, [&](std::uint32_t i) {
                return seen_on_floor(few, x, y, RandomStream::of_pixel(7, i, 0, 0)) / expected;
            });
            CHECK(found.deviation > 0);
            // Four deviations: one failure in 16,000 if the numbers were not always the same.
            CHECK(std::abs(found.value - 1) < 4 * found.deviation);
            together.value += found.value / kFloorPlaces.size();
            together.deviation += found.deviation * found.deviation;
        }
        together.deviation = std::sqrt(together.deviation) / kFloorPlaces.size();
        CHECK(std::abs(together.value - 1) < 4 * together.deviation);
        CHECK(4 * together.deviation < 0.02);  // so an error of 2 % would be seen
    }
}

TEST_CASE("a few lights bring the same mean where places on lights are random, too" *
          about_numbers) {
    TestScene all(kLamps, with_lights(0, 0.7), striped_files()),
        few(kLamps, with_lights(3, 0.7), striped_files());
    const auto mean = [](TestScene& scene, double x, double y, std::uint32_t seed) {
        return average_of(20000, [&](std::uint32_t i) {
            return seen_on_floor(scene, x, y, RandomStream::of_pixel(seed, i, 0, 0));
        });
    };
    for (const auto& [x, y] : kFloorPlaces) {
        CAPTURE(x);
        const Average a = mean(all, x, y, 1), b = mean(few, x, y, 2);
        CHECK(std::abs(a.value - b.value) < 4 * std::hypot(a.deviation, b.deviation));
        CHECK(b.deviation < 0.005 * a.value);
    }
}

TEST_CASE("samples of a picture share the choice of lights among themselves") {
    TestScene few(kLamps, with_lights(2), striped_files());
    const auto mean = [&](auto stream) {
        return average_of(200, [&](std::uint32_t picture) {
            double sum = 0;
            for (std::uint32_t i = 0; i < 16; ++i)
                sum += seen_on_floor(few, 0.7, 0.3, stream(picture, i));
            return sum / 16;
        });
    };
    const Average alone = mean([](std::uint32_t seed, std::uint32_t i) {
        return RandomStream::of_pixel(seed, 3, 4, i);
    }),
                  together = mean([](std::uint32_t seed, std::uint32_t i) {
                      return RandomStream::of_samples(seed, 3, 4, i, 16);
                  });
    CHECK(std::abs(alone.value - together.value) <
          4 * std::hypot(alone.deviation, together.deviation));
    CHECK(together.deviation < 0.75 * alone.deviation);
}

TEST_CASE(
    "a few lights cost samples a few shadow rays, and where these are all they change nothing") {
    TestScene all(kLamps, with_lights(0), striped_files()),
        few(kLamps, with_lights(2), striped_files());
    const auto shadow_rays = [](TestScene& scene) {
        const std::uint64_t before = scene.context.counters.rays.shadow;
        for (std::uint32_t i = 0; i < 100; ++i)
            (void)seen_on_floor(scene, -1.5, 0.02 * i, RandomStream::of_pixel(1, i, 0, 0));
        return scene.context.counters.rays.shadow - before;
    };
    CHECK(shadow_rays(all) > 1000);
    CHECK(shadow_rays(few) < 0.7 * static_cast<double>(shadow_rays(all)));
    CHECK(shadow_rays(few) > 100);
    const std::string two =
        "void plastic grey 0 0 5 .5 .5 .5 0 0\n"
        "grey polygon floor 0 0 12 -5 -5 0  5 -5 0  5 5 0  -5 5 0\n"
        "void light lamp 0 0 3 100 80 60\n"
        "lamp sphere a 0 0 4 1 1 3 .1\nlamp sphere b 0 0 4 -1 1 3 .1\n";
    TestScene two_of_two(two, with_lights(2)), all_of_two(two, with_lights(0));
    for (std::uint32_t i = 0; i < 20; ++i)
        CHECK(seen_on_floor(two_of_two, 0.1 * i, 0, RandomStream(i)) ==
              seen_on_floor(all_of_two, 0.1 * i, 0, RandomStream(i)));
}
