// Conservation of energy, material by material: in surroundings of radiance 1 what loses nothing
// shows 1.
#include <doctest/doctest.h>

#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

Ray trace_sheet(const std::string& material, RenderOptions options,
                const Vec3& direction = {0.6, 0.3, -1}) {
    TestScene scene(kFurnace + material + sheet("floor"), options);
    return scene.trace(-direction, direction);
}

}  // namespace

TEST_CASE("furnace: white surfaces of all kinds show radiance 1") {
    for (const char* material :
         {"void plastic m 0 0 5 1 1 1 0 0\n", "void plastic m 0 0 5 1 1 1 .05 0\n",
          "void metal m 0 0 5 1 1 1 1 0\n", "void metal m 0 0 5 1 1 1 .7 0\n",
          "void trans m 0 0 7 1 1 1 0 0 1 1\n", "void trans m 0 0 7 1 1 1 .04 0 .6 .3\n",
          "void glass m 0 0 3 1 1 1\n", "void glass m 0 0 4 1 1 1 2.2\n",
          "void mirror m 0 0 3 1 1 1\n"}) {
        for (const Vec3& direction : {Vec3{0.6, 0.3, -1}, Vec3{5, 0, -1}, Vec3{0.2, -0.4, 1}}) {
            if (std::string(material).find("mirror") != std::string::npos && direction.z > 0)
                continue;
            const Ray ray = trace_sheet(material, test::deep(), direction);
            CAPTURE(std::string(material));
            CHECK(relative_error(ray.value.r, 1) < kFloatRounding);
            CHECK(relative_error(ray.value.b, 1) < kFloatRounding);
        }
    }
}

TEST_CASE("furnace: rough lobes show radiance 1, sampled or left to the ambient light") {
    for (const double threshold : {0.0, 0.99}) {
        for (const double samples : {0.0, 0.5, 1.0}) {
            RenderOptions options = test::deep();
            options.specular_threshold = threshold;
            options.specular_samples = samples;
            for (const char* material :
                 {"void plastic m 0 0 5 1 1 1 .5 .2\n", "void metal m 0 0 5 1 1 1 .6 .1\n",
                  "void trans m 0 0 7 1 1 1 .2 .15 .5 .5\n"}) {
                CAPTURE(std::string(material));
                CAPTURE(threshold);
                CAPTURE(samples);
                CHECK(relative_error(trace_sheet(material, options).value.g, 1) < kFloatRounding);
            }
        }
    }
}

TEST_CASE(
    "furnace: many samples of a rough lobe agree with one, but for what falls below the surface") {
    RenderOptions options = test::deep();
    options.specular_threshold = 0;
    options.specular_samples = 4000;
    const double value = trace_sheet("void metal m 0 0 5 1 1 1 1 .1\n", options).value.g;
    // 4000 samples of weight near 1, of which up to 4 % fall below the surface.
    CHECK(value < 1.02);
    CHECK(value > 0.96);
}

TEST_CASE("furnace: lossless solids show radiance 1") {
    for (const char* material :
         {"void dielectric m 0 0 5 1 1 1 1.52 0\n", "void dielectric m 0 0 5 1 1 1 1.4 30\n",
          "void interface m 0 0 8 1 1 1 1.5 1 1 1 1.3\n"}) {
        TestScene scene(kFurnace + material + "m sphere ball 0 0 4 0 0 0 1\n", test::deep());
        CAPTURE(std::string(material));
        CHECK(relative_error(scene.trace({0.5, 0, 3}, {0, 0, -1}).value.g, 1) < kFloatRounding);
    }
}

TEST_CASE("radiance inside a dielectric is higher by the square of its index") {
    TestScene scene(kFurnace + "void dielectric m 0 0 5 1 1 1 1.5 0\nm sphere ball 0 0 4 0 0 0 1\n",
                    test::deep());
    CHECK(relative_error(scene.trace({0, 0, 0}, {0.3, 1, 0.2}).value.g, 1.5 * 1.5) <
          kFloatRounding);
}

TEST_CASE("an absorbing slab follows Beer's law") {
    // Index 1: no reflection. Transmission 0.5 a metre over 2 metres; the blue channel absorbs
    // nothing.
    TestScene scene(kFurnace + "void dielectric m 0 0 5 .5 .25 1 1 0\n" + sheet("top", 1) +
                        "m polygon bottom 0 0 12 -9 9 -1 9 9 -1 9 -9 -1 -9 -9 -1\n",
                    test::deep());
    const Ray ray = scene.trace({0, 0, 3}, {0, 0, -1});
    CHECK(relative_error(ray.value.r, 0.25) < kFloatRounding);
    CHECK(relative_error(ray.value.g, 0.0625) < kFloatRounding);
    CHECK(relative_error(ray.value.b, 1) < kFloatRounding);
    CHECK(relative_error(scene.trace({0, 0, 0}, {0, 0, -1}).value.r, 0.5) <
          kFloatRounding);  // from inside
}

TEST_CASE("a pane by hand: tn 0.96 over a dark floor, with a sky of 1") {
    TestScene scene(
        kFurnace + "void plastic p 0 0 5 .5 .5 .5 0 0\np ring floor 0 0 8 0 0 -1 0 0 1 0 50\n" +
            "void glass m 0 0 3 .96 .96 .96\n" + sheet("pane"),
        [] {
            RenderOptions options = test::deep();
            options.ambient_value = {0.1f, 0.1f, 0.1f};
            return options;
        }());
    CHECK(relative_error(scene.trace({0, 0, 3}, {0, 0, -1}).value.r, 0.05 * 0.881460 + 0.0786112) <
          3e-6);
}

TEST_CASE("patterns colour transmission of glass, not its reflection") {
    TestScene scene(
        kFurnace + "void brightfunc half 2 .5 . 0 0\nhalf glass m 0 0 3 1 1 1\n" + sheet("pane"),
        test::deep());
    const double r = 0.0425799, t = (1 - r) * (1 - r) / (1 - r * r);
    CHECK(relative_error(scene.trace({0, 0, 3}, {0, 0, -1}).value.r, 0.5 * t + (1 - t)) <
          kFloatRounding);
}
