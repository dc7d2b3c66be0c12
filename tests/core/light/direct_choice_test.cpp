// Direct light where ambient rays arrive: a few lights stand for all.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/light/light_sources.h"
#include "tests/core/light/lamps_over_floor.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

RenderOptions options(int lights) {
    RenderOptions o = TestScene::exact();
    o.source_subdivision = 0.2;
    o.ambient_bounces = 1;
    o.ambient_divisions = 0;  // no hemisphere is sampled: the rays of one are made here
    o.ambient_lights = lights;
    return o;
}

/// What a ray of a hemisphere, from above, brings from the floor: without further rays.
Rgb arriving(TestScene& scene, double x, double y, std::uint32_t sample) {
    Ray ray = scene.tracer.primary({x, y, 0.9}, {0.1, 0.2, -1}, 0,
                                   RandomStream::of_pixel(7, sample, 0, 0));
    ray.kind = kAmbientSame;
    ray.history = kAmbientSame;
    scene.context.path.ambient_level = 1;
    scene.tracer.trace(ray, scene.context);
    scene.context.path.ambient_level = 0;
    return ray.value;
}

struct Mean {
    double value = 0, deviation = 0;  ///< the latter of the mean
};
Mean mean_arriving(TestScene& scene, double x, double y, int samples) {
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
        const auto b =
            static_cast<double>(brightness(arriving(scene, x, y, 100U + static_cast<unsigned>(i))));
        sum += b;
        squares += b * b;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) / samples)};
}

}  // namespace

TEST_CASE("where ambient rays arrive a few lights bring in the mean what all bring") {
    TestScene all(lamps_over_floor(), options(0), striped_files());
    for (const int lights : {2, 5}) {
        TestScene few(lamps_over_floor(), options(lights), striped_files());
        for (const auto& [x, y] : {std::pair{-1.5, -1.5}, {0.7, 0.3}, {2.5, 2.0}, {-2.9, 0.1}}) {
            CAPTURE(lights);
            CAPTURE(x);
            const auto expected = static_cast<double>(brightness(arriving(all, x, y, 0)));
            const Mean found = mean_arriving(few, x, y, 10000);
            REQUIRE(expected > 0);
            CHECK(found.deviation > 0);
            CHECK(found.deviation < 0.05 * expected);
            // Four deviations: one failure in 16,000 if the numbers were not always the same.
            CHECK(std::abs(found.value - expected) < 4 * found.deviation);
        }
    }
}

TEST_CASE("where ambient rays arrive mirrored lights count as well") {
    const std::string scene_text = lamps_over_floor() +
                                   "void mirror silver 0 0 3 .9 .9 .9\nsilver polygon glass 0 0 12 "
                                   "4 -4 0  4 -4 3  4 4 3  4 4 0\n";
    RenderOptions mirrored = options(0);
    mirrored.redirections = 1;
    TestScene all(scene_text, mirrored, striped_files());
    REQUIRE(all.tracer.lights().virtual_count() > 5);
    TestScene without(lamps_over_floor(), options(0), striped_files());
    mirrored.ambient_lights = 2;
    TestScene few(scene_text, mirrored, striped_files());
    const auto expected = static_cast<double>(brightness(arriving(all, 2.5, 2, 0)));
    CHECK(expected > 1.02 * static_cast<double>(brightness(arriving(without, 2.5, 2, 0))));
    const Mean found = mean_arriving(few, 2.5, 2, 4000);
    CHECK(std::abs(found.value - expected) < 4 * found.deviation);
    CHECK(found.deviation < 0.02 * expected);
}

TEST_CASE("a few lights cost a few shadow rays, and few sources or eye rays nothing else") {
    TestScene all(lamps_over_floor(), options(0), striped_files()),
        few(lamps_over_floor(), options(2), striped_files());
    const auto shadow_rays = [](TestScene& scene) {
        const std::uint64_t before = scene.context.counters.rays.shadow;
        for (std::uint32_t i = 0; i < 100; ++i) (void)arriving(scene, -1.5, 0.02 * i, i);
        return scene.context.counters.rays.shadow - before;
    };
    CHECK(shadow_rays(all) > 1000);
    CHECK(shadow_rays(few) <= 100 * 3);
    CHECK(shadow_rays(few) > 100);
    for (int i = 0; i < 20; ++i) {
        const Vec3 eye{-1.5, 0.1 * i, 0.9}, down{0.1, 0.2, -1};
        CHECK(few.trace(eye, down).value == all.trace(eye, down).value);
    }
    const std::string two = kShinyFloor +
                            "void light lamp 0 0 3 100 80 60\nlamp sphere a 0 0 4 1 1 3 .1\nlamp "
                            "sphere b 0 0 4 -1 1 3 .1\n";
    TestScene two_of_two(two, options(2)), all_of_two(two, options(0));
    for (std::uint32_t i = 0; i < 20; ++i)
        CHECK(arriving(two_of_two, 0.1 * i, 0, i) == arriving(all_of_two, 0.1 * i, 0, i));
}
