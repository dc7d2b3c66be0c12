// What a ray meets on its way to a light source.
#include <doctest/doctest.h>

#include "core/material/fresnel.h"
#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kLamp =
    "void light lamp 0 0 3 100 100 100\nlamp sphere bulb 0 0 4 0 0 8 .25\n"
    "void plastic matte 0 0 5 .5 .5 .5 0 0\nmatte ring floor 0 0 8 0 0 0 0 0 1 0 5\n";

/// Share of the lamp's light that reaches the floor through a sheet at height 4, facing up.
double share_through(const std::string& material, RenderOptions options = TestScene::exact()) {
    const auto floor_below = [&](const std::string& scene_text) {
        TestScene scene(scene_text, options);
        return static_cast<double>(scene.trace({0, 0, 1}, {0, 0, -1}).value.r);
    };
    return floor_below(kLamp + material + test::sheet("s", 4)) / floor_below(kLamp);
}

}  // namespace

TEST_CASE("opaque and rough materials block shadow rays, also seen from behind and with -bv-") {
    for (const bool back_faces : {true, false}) {
        RenderOptions options = TestScene::exact();
        options.back_faces_visible = back_faces;
        for (const char* material :
             {"void plastic m 0 0 5 1 1 1 0 0\n", "void metal m 0 0 5 1 1 1 1 0\n",
              "void plastic2 m 4 1 0 0 . 0 6 1 1 1 .2 .1 .2\n",
              "void metal2 m 4 1 0 0 . 0 6 1 1 1 .2 .1 .2\n",
              "void trans2 m 4 1 0 0 . 0 8 1 1 1 0 .1 .1 1 1\n",
              "void ashik2 m 4 1 0 0 . 0 8 1 1 1 0 0 0 9 9\n"}) {
            CAPTURE(std::string(material));
            CHECK(share_through(material, options) == 0);
        }
    }
    CHECK(share_through("void trans m 0 0 7 1 1 1 0 .1 1 1\n") == 0);
    CHECK(share_through("void mirror m 0 0 3 1 1 1\n") == 0);
    CHECK(share_through("void prism1 m 5 1 Dx Dy Dz . 0 0\n") == 0);
    CHECK(share_through("void light m 0 0 3 0 0 0\n") == 0);
}

TEST_CASE("smooth transmission passes shadow rays straight on") {
    CHECK(relative_error(share_through("void trans m 0 0 7 1 1 1 0 0 1 1\n"), 1) < kFloatRounding);
    CHECK(relative_error(share_through("void trans m 0 0 7 .8 .8 .8 0 0 .5 .6\n"), 0.8 * 0.3) <
          1e-6);
    CHECK(relative_error(share_through("void trans m 0 0 7 .8 .8 .8 0 .001 .5 .6\n"), 0.8 * 0.3) <
          1e-6);
    const double r = 0.0425799;
    CHECK(relative_error(share_through("void glass m 0 0 3 1 1 1\n"), (1 - r) / (1 + r)) <
          kFloatRounding);
    CHECK(share_through("void glass m 0 0 3 0 0 0\n") == 0);
    CHECK(relative_error(
              share_through("void BRTDfunc m 10 0 0 0 .4 .4 .4 0 0 0 . 0 9 0 0 0 0 0 0 0 0 0\n"),
              0.4) < kFloatRounding);
}

TEST_CASE("with -bv- the back of trans and glass is not there") {
    RenderOptions options = TestScene::exact();
    options.back_faces_visible = false;
    // The sheet faces up, towards the lamp: the shadow ray meets its back.
    CHECK(relative_error(share_through("void trans m 0 0 7 .8 .8 .8 0 0 .5 .6\n", options), 1) <
          1e-6);
    CHECK(relative_error(share_through("void trans m 0 0 7 .8 .8 .8 0 .1 .5 .6\n", options), 1) <
          1e-6);
    CHECK(relative_error(share_through("void glass m 0 0 3 .5 .5 .5\n", options), 1) <
          kFloatRounding);
    CHECK(relative_error(share_through("void glass m 0 0 3 0 0 0\n", options), 1) < kFloatRounding);
}

TEST_CASE("a slab between parallel faces passes shadow rays, losing two reflections") {
    const double r = refract(1, 1 / 1.5).reflectance;
    const std::string bottom = "m polygon b 0 0 12 -9 9 3 9 9 3 9 -9 3 -9 -9 3\n";
    CHECK(relative_error(share_through("void dielectric m 0 0 5 1 1 1 1.5 0\n" + bottom),
                         (1 - r) * (1 - r)) < kFloatRounding);
}

TEST_CASE("mist absorbs light on its way") {
    const std::string bottom = "m polygon b 0 0 12 -9 9 3 9 9 3 9 -9 3 -9 -9 3\n";
    CHECK(relative_error(share_through("void mist m 0 0 3 .7 .7 .7\n" + bottom), std::exp(-0.7)) <
          1e-5);
    // What is scattered counts as light that arrives.
    CHECK(relative_error(share_through("void mist m 0 0 6 .7 .7 .7 .4 .4 .4\n" + bottom),
                         std::exp(-0.7 * 0.6)) < kFloatRounding);
}
