// mist and antimatter: what is in, and what is cut out of, a volume.
#include <doctest/doctest.h>

#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

TEST_CASE("mist absorbs over the way through it, in its own colours") {
    TestScene scene(
        kFurnace + "void mist m 0 0 3 .3 .2 0\nm sphere cloud 0 0 4 0 0 0 1\n" +
        "void glow g 0 0 4 1 1 1 0\ng polygon floor 0 0 12 -9 -9 -5 9 -9 -5 9 9 -5 -9 9 -5\n");
    const Ray through = scene.trace({0, 0, 3}, {0, 0, -1});
    CHECK(relative_error(through.value.r, std::exp(-0.6)) < kFloatRounding);
    CHECK(relative_error(through.value.g, std::exp(-0.4)) < kFloatRounding);
    CHECK(through.value.b == 1);
    CHECK(through.effective_distance() == rounded(8));
    // From inside, without listed sources, the first segment is clear: so is Radiance's.
    CHECK(scene.trace({0, 0, 0}, {0, 0, -1}).value.r == 1);
}

TEST_CASE("a ray that begins inside a mist with sources learns so when it leaves") {
    TestScene scene(
        "void light l 0 0 3 1 1 1\nl sphere lamp 0 0 4 0 0 6 .1\nvoid mist m 1 lamp 0 3 .3 .2 0\n"
        "m sphere cloud 0 0 4 0 0 0 1\nvoid glow g 0 0 4 1 1 1 0\n"
        "g polygon floor 0 0 12 -9 -9 -5 9 -9 -5 9 9 -5 -9 9 -5\n");
    CHECK(relative_error(scene.trace({0, 0, 0}, {0, 0, -1}).value.r, std::exp(-0.3)) <
          kFloatRounding);
    CHECK(relative_error(scene.trace({0, 0, 3}, {0, 0, -1}).value.r, std::exp(-0.6)) <
          kFloatRounding);
}

TEST_CASE("mist warns of sources that it does not find or that it names twice") {
    TestScene scene(
        "void mist m 3 lamp lamp moon 0 3 .3 .2 0\nm sphere cloud 0 0 4 0 0 0 1\n"
        "void light l 0 0 3 1 1 1\nl sphere lamp 0 0 4 0 0 6 .1\n");
    (void)scene.trace({0, 0, 3}, {0, 0, -1});
    REQUIRE(scene.warnings.messages.size() >= 2);
    CHECK(scene.warnings.messages[0] == "test.rad:1: mist \"m\": duplicate source \"lamp\"");
    CHECK(scene.warnings.messages[1] == "test.rad:1: mist \"m\": unknown source \"moon\"");
}

namespace {

/// A ball of radius 1 with a bite of radius 0.6 at its front (-y); all emit, so that what is seen
/// is plain.
std::string bitten(const std::string& cut) {
    return "void glow ball 0 0 4 1 1 1 0\nvoid glow face 0 0 4 2 2 2 0\nvoid glow other 0 0 4 3 3 "
           "3 0\n" +
           cut +
           "ball sphere b 0 0 4 0 0 0 1\nother sphere o 0 0 4 0 9 0 1\nm sphere bite 0 0 4 0 -1 0 "
           ".6\n";
}

}  // namespace

TEST_CASE("antimatter cuts a volume out and shows the cut in its first material") {
    TestScene scene(bitten("void antimatter m 2 face ball 0 0\n"));
    const Ray ray = scene.trace({0, -3, 0}, {0, 1, 0});
    CHECK(ray.value.r == 2);
    CHECK(ray.effective_distance() == rounded(2.6));
    CHECK(scene.trace({0.8, -3, 0}, {0, 1, 0}).value.r == 1);  // beside the bite
}

TEST_CASE("antimatter beginning with void opens the cut") {
    TestScene scene(bitten("void antimatter m 2 void ball 0 0\n"));
    // Through the hole, past the back of the ball from inside (a glow's back is black).
    CHECK(scene.trace({0, -3, 0}, {0, 1, 0}).value.r == 0);
    TestScene open(bitten("void antimatter m 2 void ball 0 0\n"), [] {
        RenderOptions options = TestScene::exact();
        options.back_faces_visible = false;
        return options;
    }());
    CHECK(open.trace({0, -3, 0}, {0, 1, 0}).value.r == 3);
}

TEST_CASE("antimatter leaves other modifiers alone, and warns of names that it does not know") {
    TestScene scene(bitten("void antimatter m 4 face ball ball nothing 0 0\n") +
                    "other sphere inside 0 0 4 0 -1 0 .2\n");
    CHECK(scene.trace({0, -3, 0}, {0, 1, 0}).value.r == 3);
    REQUIRE(scene.warnings.messages.size() >= 2);
    CHECK(scene.warnings.messages[0] ==
          "test.rad:4: antimatter \"m\": duplicate modifier \"ball\"");
    CHECK(scene.warnings.messages[1] ==
          "test.rad:4: antimatter \"m\": undefined modifier \"nothing\"");
}

TEST_CASE("sets made on a path are forgotten when the next one starts, however it starts") {
    // Within both bites other matter is clipped than within one: a set of its own.
    TestScene scene(
        bitten("void antimatter m 2 void ball 0 0\nvoid antimatter n 2 void other 0 0\n") +
        "n sphere inner 0 0 4 0 -1 0 .3\n");
    const auto bite = [&](std::uint16_t kind) {
        Ray ray = scene.tracer.primary({0, -3, 0}, {0, 1, 0}, 0, RandomStream());
        ray.kind = kind;  // small light sources start with a shadow ray
        scene.tracer.trace(ray, scene.context);
        return scene.context.path.clip_sets.size();
    };
    const std::size_t one = bite(kPrimary);
    CHECK(one > 0);
    CHECK(bite(kPrimary) == one);
    CHECK(bite(kShadow) <= one);
    (void)scene.tracer.irradiance({0, 0, 50}, {0, 0, 1}, RandomStream(), scene.context);
    CHECK(scene.context.path.clip_sets.empty());
    CHECK(scene.context.path.nesting.rays == 0);
}
