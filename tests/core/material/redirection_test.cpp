// mirror, prism1, prism2: what the eye sees in them. Redirected light is tested with the light
// sources.
#include <doctest/doctest.h>

#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// A wall of the modifier m at x = 4 facing the origin, a lit wall of radiance 2 at x = -4.
const std::string kWalls =
    "m polygon wall 0 0 12 4 -3 0 4 -3 4 4 3 4 4 3 0\n"
    "void glow lit 0 0 4 2 2 2 0\nlit polygon back 0 0 12 -4 3 0 -4 3 4 -4 -3 4 -4 -3 0\n";

}  // namespace

TEST_CASE("a mirror shows what is before it, dimmed, at its unfolded distance") {
    TestScene scene("void mirror m 0 0 3 .9 .5 .1\n" + kWalls);
    const Ray ray = scene.trace({0, 0, 2}, {1, 0, 0});
    CHECK(relative_error(ray.value.r, 1.8) < kFloatRounding);
    CHECK(relative_error(ray.value.b, 0.2) < kFloatRounding);
    CHECK(ray.effective_distance() == rounded(12));
    CHECK(ray.unreflected_path_length == rounded(4));
    CHECK(scene.trace({9, 0, 2}, {-1, 0, 0}).value == Rgb{});  // its back
}

TEST_CASE("a mirror's alternate is what the eye sees, void is nothing") {
    TestScene painted("void glow paint 0 0 4 5 5 5 0\nvoid mirror m 1 paint 0 3 .9 .9 .9\n" +
                      kWalls);
    CHECK(painted.trace({0, 0, 2}, {1, 0, 0}).value.r == 5);
    TestScene absent("void mirror m 1 void 0 3 .9 .9 .9\n" + kWalls +
                     "lit ring far 0 0 8 8 0 2 -1 0 0 0 1\n");
    const Ray ray = absent.trace({0, 0, 2}, {1, 0, 0});
    CHECK(ray.value.r == 2);
    CHECK(ray.effective_distance() == rounded(8));
}

TEST_CASE("a prism shows the direction that its expressions give, with their coefficient") {
    // Straight back: the lit wall, though the ray flies on towards +x.
    TestScene turned("void prism1 m 5 .7 -1 0 0 . 0 0\n" + kWalls);
    CHECK(relative_error(turned.trace({0, 0, 2}, {1, 0, 0}).value.r, 1.4) < kFloatRounding);
    TestScene onward("void prism1 m 5 .7 Dx Dy Dz . 0 0\n" + kWalls);
    CHECK(onward.trace({0, 0, 2}, {1, 0, 0}).value.r == 0);
}

TEST_CASE("both directions of a prism2 add, and a failed expression drops its own only") {
    TestScene both("void prism2 m 9 .7 -1 0 0 .2 -1 0 .1 . 0 0\n" + kWalls);
    CHECK(relative_error(both.trace({0, 0, 2}, {1, 0, 0}).value.r, 1.8) < kFloatRounding);
    TestScene one("void prism2 m 9 .7 -1 0 0 sqrt(-Dx) -1 0 .1 . 0 0\n" + kWalls);
    CHECK(relative_error(one.trace({0, 0, 2}, {1, 0, 0}).value.r, 1.4) < kFloatRounding);
    CHECK(!one.warnings.messages.empty());
}

TEST_CASE("a prism's directions turn with its transform") {
    TestScene scene("void prism1 m 7 .7 0 1 0 . -rz 90 0 0\n" + kWalls);
    CHECK(relative_error(scene.trace({0, 0, 2}, {1, 0, 0}).value.r, 1.4) < kFloatRounding);
}
