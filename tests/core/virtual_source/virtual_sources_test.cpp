#include "core/virtual_source/virtual_sources.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kFloor =
    "void plastic grey\n0\n0\n5 .5 .5 .5 0 0\ngrey polygon floor\n0\n0\n12 -50 -50 0 50 -50 0 50 "
    "50 0 -50 50 0\n";
const std::string kMirror =
    "void mirror silver\n0\n0\n3 .9 .8 .7\nsilver polygon glass\n0\n0\n12 4 -2 0  4 -2 4  4 2 4  4 "
    "2 0\n";
const std::string kLamp =
    "void light lamp\n0\n0\n3 100 100 100\nlamp sphere bulb\n0\n0\n4 0 0 3 .2\n";

RenderOptions with_redirections(int redirections, double pretest = 0) {
    RenderOptions options = TestScene::exact();
    options.redirections = redirections;
    options.virtual_source_pretest = pretest;
    return options;
}

double floor_at(TestScene& scene, double x, double y) {
    return static_cast<double>(scene.trace({x, y, 0.5}, {0, 0, -1}).value.r);
}

}  // namespace

TEST_CASE(
    "a lamp before a mirror lights the floor twice: from where it is and from where it appears") {
    TestScene scene(kFloor + kMirror + kLamp, with_redirections(1));
    REQUIRE(scene.tracer.lights().virtual_count() == 1);
    const LightSource& made = scene.tracer.lights()[1];
    CHECK(length(made.center - Vec3{8, 0, 3}) < kRounding);
    CHECK(made.parent == 0);
    CHECK(made.follow);
    const double direct = 0.5 * 100 * 0.04 / 10 * 3 / std::sqrt(10.0);
    const double redirected = 0.9 * 0.5 * 100 * 0.04 / 58 * 3 / std::sqrt(58.0);
    CHECK(floor_at(scene, 1, 0) == float_rounded(direct + redirected));
    TestScene without(kFloor + kMirror + kLamp, with_redirections(0));
    CHECK(without.tracer.lights().virtual_count() == 0);
    CHECK(floor_at(without, 1, 0) == float_rounded(direct));
    // Where the mirror's outline cuts the path nothing arrives: the light would have to pass at y
    // = 2.5.
    CHECK(floor_at(scene, 1, 5.9) == rounded(floor_at(without, 1, 5.9)));
}

TEST_CASE("shadows fall on both legs of a redirected path") {
    const std::string scene = kFloor + kMirror + kLamp;
    TestScene clear(scene, with_redirections(1)), none(scene, with_redirections(0));
    // Between lamp and mirror, and between mirror and floor; neither is on the direct path.
    for (const char* ball : {"2 0 2.143 .1", "3.5 0 1.071 .1"}) {
        TestScene blocked(scene + "grey sphere ball\n0\n0\n4 " + ball + "\n", with_redirections(1));
        CHECK(floor_at(clear, 1, 0) > floor_at(none, 1, 0));
        CHECK(floor_at(blocked, 1, 0) == rounded(floor_at(none, 1, 0)));
    }
}

TEST_CASE("two mirrors: each alone with -dr 1, one in the other with -dr 2") {
    const std::string scene = kFloor + kMirror +
                              "silver polygon left\n0\n0\n12 -4 -2 0  -4 2 0  -4 2 4  -4 -2 4\n" +
                              kLamp;
    CHECK(TestScene(scene, with_redirections(1)).tracer.lights().virtual_count() == 2);
    CHECK(TestScene(scene, with_redirections(2)).tracer.lights().virtual_count() == 4);
    CHECK(TestScene(scene, with_redirections(3)).tracer.lights().virtual_count() == 6);
    TestScene two(scene, with_redirections(2));
    CHECK(floor_at(two, 1, 0) >
          floor_at(*std::make_unique<TestScene>(scene, with_redirections(1)), 1, 0));
    const auto& lights = two.tracer.lights();
    CHECK(lights.find("bulb") == 0);
    REQUIRE(lights.find("glass>bulb"));
    CHECK(lights[*lights.find("glass>bulb")].parent == 0);
    REQUIRE(lights.find("left>glass>bulb"));
    CHECK(lights[*lights.find("left>glass>bulb")].parent == *lights.find("glass>bulb"));
    CHECK_FALSE(lights.find("glass>glass>bulb"));
    CHECK_FALSE(lights.find("glass"));
    CHECK_FALSE(lights.find("glass>"));
}

TEST_CASE(
    "sunlight from a mirror is as strong as the sun times the reflectance, inside the beam only") {
    const std::string sun =
        "void light suncol\n0\n0\n3 1e5 1e5 1e5\nsuncol source sun\n0\n0\n4 -1 0 1 .5\n";
    TestScene scene(kFloor + kMirror + sun, with_redirections(1)),
        none(kFloor + kMirror + sun, with_redirections(0));
    REQUIRE(scene.tracer.lights().virtual_count() == 1);
    const double direct = floor_at(none, 2, 0);
    CHECK(floor_at(scene, 2, 0) == float_rounded(1.9 * direct));
    CHECK(floor_at(scene, -2, 0) == rounded(direct));
    CHECK(floor_at(scene, 2, 2.5) == rounded(direct));
}

TEST_CASE(
    "the pretest changes no light: it discards what is hidden and stops following what is clear") {
    const std::string scene = kFloor + kMirror + kLamp;
    TestScene clear(scene, with_redirections(1, 512)), untested(scene, with_redirections(1));
    REQUIRE(clear.tracer.lights().virtual_count() == 1);
    CHECK_FALSE(clear.tracer.lights()[1].follow);
    CHECK(floor_at(clear, 1, 0) == rounded(floor_at(untested, 1, 0)));
    TestScene hidden(scene + "grey polygon w\n0\n0\n12 3 -9 0  3 -9 9  3 9 9  3 9 0\n",
                     with_redirections(1, 512));
    CHECK(hidden.tracer.lights().virtual_count() == 0);
    TestScene partly(scene + "grey polygon w\n0\n0\n12 3 0 0  3 0 9  3 9 9  3 9 0\n",
                     with_redirections(1, 512));
    REQUIRE(partly.tracer.lights().virtual_count() == 1);
    CHECK(partly.tracer.lights()[1].follow);
}

TEST_CASE("lamps behind a mirror and curved mirrors redirect nothing") {
    TestScene behind(
        kFloor + kMirror + "void light lamp\n0\n0\n3 1 1 1\nlamp sphere bulb\n0\n0\n4 6 0 3 .2\n",
        with_redirections(1));
    CHECK(behind.tracer.lights().virtual_count() == 0);
    TestScene ball(
        kLamp + "void mirror silver\n0\n0\n3 .9 .8 .7\nsilver sphere ball\n0\n0\n4 4 0 3 1\n",
        with_redirections(1));
    CHECK(ball.tracer.lights().virtual_count() == 0);
    REQUIRE(ball.warnings.messages.size() == 1);
    CHECK(ball.warnings.messages[0] ==
          "test.rad:13: sphere \"ball\": only flat surfaces relay light to others");
}

TEST_CASE("a prism sheet redirects by its expressions, an undeviated one makes no virtual source") {
    const std::string sheet = " polygon sheet\n0\n0\n12 -3 -3 3  3 -3 3  3 3 3  -3 3 3\n";
    const std::string lamp =
        "void light lamp\n0\n0\n3 100 100 100\nlamp sphere bulb\n0\n0\n4 0 0 6 .3\n";
    TestScene bend(
        kFloor + lamp + "void prism1 bend\n5 .7 Dx-.3*abs(Dz) Dy Dz .\n0\n0\nbend" + sheet,
        with_redirections(1));
    REQUIRE(bend.tracer.lights().virtual_count() == 1);
    CHECK(length(bend.tracer.lights()[1].center - Vec3{0.9, 0, 6}) < kRounding);
    const double squared = 1.9 * 1.9 + 36;
    CHECK(floor_at(bend, -1, 0) ==
          float_rounded(0.7 * 0.5 * 100 * 0.09 / squared * 6 / std::sqrt(squared)));
    TestScene straight(kFloor + lamp + "void prism1 none\n5 1 Dx Dy Dz .\n0\n0\nnone" + sheet,
                       with_redirections(1));
    CHECK(straight.tracer.lights().virtual_count() == 0);
    CHECK(floor_at(straight, 0, 0) == 0);
    TestScene split(
        kFloor + lamp +
            "void prism2 two\n9 .4 Dx+.2*abs(Dz) Dy Dz .3 Dx-.2*abs(Dz) Dy Dz .\n0\n0\ntwo" + sheet,
        with_redirections(1));
    REQUIRE(split.tracer.lights().virtual_count() == 2);
    CHECK(split.tracer.lights()[1].branch == 0);
    CHECK(split.tracer.lights()[2].branch == 1);
}

TEST_CASE("facing mirrors: the number of virtual sources is bounded, whatever -dr says") {
    const std::string scene =
        kMirror + "silver polygon left\n0\n0\n12 -4 -2 0  -4 2 0  -4 2 4  -4 -2 4\n" + kLamp;
    CHECK(TestScene(scene, with_redirections(1000000)).tracer.lights().virtual_count() <=
          2 * static_cast<std::size_t>(kMaxRedirections));
}

TEST_CASE("a flat lamp beside an upright mirror shines on from where it appears, however high") {
    // Radiance 6.1's rtrace drops the image of a lamp that faces up where the middle of the mirror
    // lies below the lamp (2.845e-03 here, as with -dr 0), and has it (4.898e-03) with the part of
    // the mirror alone by which the light comes, z from 2.2.
    const auto at_ceiling = [](const std::string& mirror, int redirections) {
        const std::string room =
            "void plastic white\n0\n0\n5 .8 .8 .8 0 0\nvoid light lamp\n0\n0\n3 25 25 25\n"
            "white polygon ceiling\n0\n0\n12 -1.5 1 2.5 -1.5 10 2.5 1.5 10 2.5 1.5 1 2.5\n";
        const auto panel = [](const std::string& name, double from, double to) {
            return "lamp polygon " + name + "\n0\n0\n12 -1.4 " + std::to_string(from) +
                   " 2.11 -1.4 " + std::to_string(to) + " 2.11 -1.34 " + std::to_string(to) +
                   " 2.11 -1.34 " + std::to_string(from) + " 2.11\n";
        };
        TestScene scene(room + mirror + panel("panel", 8.5, 7.5) +
                            (mirror.empty() ? panel("image", 12.5, 11.5) : std::string()),
                        with_redirections(redirections));
        return static_cast<double>(scene.trace({-.5, 9.9, 2.4}, {0, 0, 1}).value.r);
    };
    const auto mirror = [](const std::string& low) {
        return "void mirror glass\n0\n0\n3 1 1 1\nglass polygon wall\n0\n0\n12 -1.5 10 " + low +
               " 1.5 10 " + low + " 1.5 10 2.5 -1.5 10 2.5\n";
    };
    CHECK(at_ceiling(mirror("0"), 0) == printed(4, 2.845e-3));
    CHECK(at_ceiling(mirror("0"), 1) == printed(4, 4.898e-3));
    CHECK(at_ceiling(mirror("2.2"), 1) == printed(4, 4.898e-3));
    CHECK(at_ceiling("", 0) == printed(4, 4.898e-3));  // two lamps, no mirror
}
