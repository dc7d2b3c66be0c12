// Direct light where ambient rays arrive: a few lights stand for all.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "core/light/light_sources.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kFloor =
    "void plastic shiny 0 0 5 .5 .4 .3 .03 .1\n"
    "shiny polygon floor 0 0 12 -5 -5 0  5 -5 0  5 5 0  -5 5 0\n"
    "shiny polygon wall 0 0 12 .2 -1 .1  .2 -1 1.5  .2 1 1.5  .2 1 .1\n";

/// Twelve lamps of all kinds, of which a wall hides some.
std::string many_lights() {
    std::ostringstream text;
    text << kFloor
         << "void light lamp 0 0 3 100 80 60\n"
            "void brightfunc stripes 2 stripe stripes.cal 0 0\nstripes light striped 0 0 3 30 30 "
            "30\n"
            "void spotlight beam 0 0 7 900 900 900 60 0 0 -1\n"
            "void glow near 0 0 4 50 50 50 2.5\n";
    for (int i = 0; i < 7; ++i)
        text << "lamp sphere s" << i << " 0 0 4 " << (i * 7 % 11) * .3 - 1.5 << ' '
             << (i * 5 % 9) * .3 - 1.2 << " 3 .1\n";
    text << "striped polygon panel 0 0 12 -2 -2 2  -2 -1 2  -1 -1 2  -1 -2 2\n"
            "lamp polygon window 0 0 12 -3 -1 1  -3 1 1  -3 1 2  -3 -1 2\n"
            "beam ring spot 0 0 8 1 1 3  0 0 -1  0 .1\n"
            "near sphere ball 0 0 4 -1 2 2 .2\n"
            "lamp source sun 0 0 4 .5 .2 1 1\n";
    return text.str();
}

MemoryResources stripes() {
    MemoryResources files;
    files.functions["stripes.cal"] = "stripe = 1 + .9*sin(20*Px)*sin(9*Dy);";
    return files;
}

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
    TestScene all(many_lights(), options(0), stripes());
    for (const int lights : {2, 5}) {
        TestScene few(many_lights(), options(lights), stripes());
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
    const std::string scene_text = many_lights() +
                                   "void mirror silver 0 0 3 .9 .9 .9\nsilver polygon glass 0 0 12 "
                                   "4 -4 0  4 -4 3  4 4 3  4 4 0\n";
    RenderOptions mirrored = options(0);
    mirrored.redirections = 1;
    TestScene all(scene_text, mirrored, stripes());
    REQUIRE(all.tracer.lights().virtual_count() > 5);
    TestScene without(many_lights(), options(0), stripes());
    mirrored.ambient_lights = 2;
    TestScene few(scene_text, mirrored, stripes());
    const auto expected = static_cast<double>(brightness(arriving(all, 2.5, 2, 0)));
    CHECK(expected > 1.02 * static_cast<double>(brightness(arriving(without, 2.5, 2, 0))));
    const Mean found = mean_arriving(few, 2.5, 2, 4000);
    CHECK(std::abs(found.value - expected) < 4 * found.deviation);
    CHECK(found.deviation < 0.02 * expected);
}

TEST_CASE("a few lights cost a few shadow rays, and few sources or eye rays nothing else") {
    TestScene all(many_lights(), options(0), stripes()), few(many_lights(), options(2), stripes());
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
    const std::string two = kFloor +
                            "void light lamp 0 0 3 100 80 60\nlamp sphere a 0 0 4 1 1 3 .1\nlamp "
                            "sphere b 0 0 4 -1 1 3 .1\n";
    TestScene two_of_two(two, options(2)), all_of_two(two, options(0));
    for (std::uint32_t i = 0; i < 20; ++i)
        CHECK(arriving(two_of_two, 0.1 * i, 0, i) == arriving(all_of_two, 0.1 * i, 0, i));
}
