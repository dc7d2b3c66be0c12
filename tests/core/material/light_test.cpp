// What rays see that hit light sources.
#include <doctest/doctest.h>

#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr const char* kPanel = " polygon panel 0 0 12 -1 -1 3 -1 1 3 1 1 3 1 -1 3\n";  // faces down

double seen(const std::string& material, const Vec3& direction,
            RenderOptions options = TestScene::exact()) {
    TestScene scene(
        "void glow sky 0 0 4 .5 .5 .5 0\nsky source up 0 0 4 0 0 1 180\n" + material + "m" + kPanel,
        options);
    const Vec3 origin = Vec3{0, 0, 3} - direction;
    return static_cast<double>(scene.trace(origin, direction).value.r);
}

const Vec3 kFront{0, 0, 1}, kBack{0, 0, -1};

}  // namespace

TEST_CASE("the eye sees the front of a light, its back is black, or not there") {
    CHECK(seen("void light m 0 0 3 7 7 7\n", kFront) == 7);
    CHECK(seen("void light m 0 0 3 7 7 7\n", kBack) == 0);
    CHECK(seen("void glow m 0 0 4 6 6 6 5\n", kFront) == 6);
    RenderOptions options = TestScene::exact();
    options.back_faces_visible = false;
    TestScene scene(
        "void glow sky 0 0 4 .5 .5 .5 0\nsky source up 0 0 4 0 0 -1 180\nvoid light m 0 0 3 7 7 "
        "7\nm" +
            std::string(kPanel),
        options);
    CHECK(scene.trace({0, 0, 4}, kBack).value.r == 0.5f);
}

TEST_CASE("a spotlight is seen inside its cone only") {
    const std::string spot = "void spotlight m 0 0 7 9 9 9 40 0 0 -1\n";
    CHECK(seen(spot, kFront) == 9);
    CHECK(seen(spot, normalize(Vec3{std::tan(19 * kPi / 180), 0, 1})) == 9);
    CHECK(seen(spot, normalize(Vec3{std::tan(21 * kPi / 180), 0, 1})) == 0);
}

TEST_CASE("a spotlight needs a cone and a direction") {
    CHECK_THROWS_WITH_AS(seen("void spotlight m 0 0 7 9 9 9 0 0 0 -1\n", kFront),
                         doctest::Contains("zero angle"), InputError);
    CHECK_THROWS_WITH_AS(seen("void spotlight m 0 0 7 9 9 9 40 0 0 0\n", kFront),
                         doctest::Contains("spotlight \"m\""), InputError);
}

TEST_CASE("an illum shows its alternate, or what is behind it") {
    CHECK(seen("void illum m 0 0 3 7 7 7\n", kFront) == 0.5);
    CHECK(seen("void illum m 1 void 0 3 7 7 7\n", kFront) == 0.5);
    CHECK(seen("void illum m 1 no_such_name 0 3 7 7 7\n", kFront) == 0.5);
    CHECK(seen("void glow a 0 0 4 3 3 3 0\nvoid illum m 1 a 0 3 7 7 7\n", kFront) == 3);
}

TEST_CASE("-dv- hides sources from the eye, but not glow beyond its radius") {
    RenderOptions hidden = TestScene::exact();
    hidden.sources_visible = false;
    CHECK(seen("void light m 0 0 3 7 7 7\n", kFront, hidden) == 0);
    CHECK(seen("void glow m 0 0 4 6 6 6 5\n", kFront, hidden) == 0);  // 1 away
    CHECK(seen("void glow m 0 0 4 6 6 6 .5\n", kFront, hidden) == 6);
    CHECK(seen("void glow m 0 0 4 6 6 6 0\n", kFront, hidden) == 6);
    CHECK(seen("void glow m 0 0 4 6 6 6 -1\n", kFront, hidden) == 0);
}

TEST_CASE("rough samples see only what the direct calculation leaves out") {
    // A rough metal floor under a panel that fills its lobe; no direct light from a glow without
    // influence.
    const auto sampled = [](const std::string& material) {
        RenderOptions options = TestScene::exact();
        options.specular_threshold = 0;
        TestScene scene(material + "m" + kPanel +
                            "void metal f 0 0 5 1 1 1 1 .05\nf ring floor 0 0 8 0 0 0 0 0 1 0 5\n",
                        options);
        return static_cast<double>(scene.trace({0, 0, 1}, {0, 0, -1}).value.r);
    };
    const double direct_only = sampled("void light m 0 0 3 2 2 2\n");
    CHECK(direct_only > 0);
    CHECK(sampled("void glow m 0 0 4 2 2 2 10\n") == float_rounded(direct_only));
    CHECK(sampled("void glow m 0 0 4 2 2 2 1\n") == 2);  // 3 away: seen, not sampled
    CHECK(sampled("void glow m 0 0 4 2 2 2 0\n") == 2);
    CHECK(sampled("void glow m 0 0 4 2 2 2 -1\n") == 0);
    CHECK(sampled("void illum m 0 0 3 2 2 2\n") == float_rounded(direct_only));
}

TEST_CASE("patterns colour what is emitted") {
    CHECK(seen("void brightfunc p 2 .25 . 0 0\np light m 0 0 3 8 8 8\n", kFront) == 2);
}

TEST_CASE("an alternate that nothing defines is a warning with its place, and stands for void") {
    for (const char* type : {"illum", "mirror"}) {
        TestScene scene("void " + std::string(type) + " pane\n1 lost\n0\n3 1 1 1\n" +
                        "pane ring r\n0\n0\n8 0 0 0 0 0 1 0 1\n");
        REQUIRE(!scene.warnings.messages.empty());
        CHECK(scene.warnings.messages[0] ==
              "test.rad:1: " + std::string(type) + " \"pane\": undefined modifier \"lost\"");
    }
}
