#include "core/cloud/highlights.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/cloud/scene_sights.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::TestScene;

namespace {

/// A satin floor under a lamp.
const std::string kFloor = R"(
void plastic satin 0 0 5 .4 .4 .4 .05 .08
void light lamp 0 0 3 900 900 900
satin polygon floor 0 0 12  -50 -50 0  50 -50 0  50 50 0  -50 50 0
lamp sphere bulb 0 0 4 0 4 4 .1
)";

/// Radiance of the floor's origin, seen from y < 0 at a height angle.
double seen_at(TestScene& scene, double angle) {
    const Vec3 away{0, -std::cos(angle), std::sin(angle)};
    return static_cast<double>(scene.trace(away * 4, -away).value.g);
}

double slope_at(const TestScene& scene, double angle) {
    const Vec3 away{0, -std::cos(angle), std::sin(angle)};
    const Hit hit = scene.scene.geometry().intersect({away * 4, -away});
    REQUIRE(hit.exists());
    return Highlights(scene.tracer.lights(), scene.tracer.options())
        .slope(hit, -away, {.05, .95 * .4, .08});
}

}  // namespace

TEST_CASE("highlights: where the slope says that colour holds for a turn, it does") {
    TestScene scene(kFloor);
    int steady = 0, steep = 0;
    for (double angle = 0.1; angle < kPi / 2; angle += 0.01) {
        CAPTURE(angle);
        const double slope = slope_at(scene, angle);
        const double turn = slope > 0 ? 0.05 / slope : 0.8;
        const double here = seen_at(scene, angle);
        for (const double there : {angle + turn, angle - turn, angle + turn / 2}) {
            if (there < 0.05 || there > kPi - 0.05) continue;
            // A twentieth by the lobe, and what its height adds.
            CHECK(std::abs(seen_at(scene, there) - here) <= 0.075 * here);
        }
        steady += turn >= 0.2 ? 1 : 0;
        steep += turn <= 0.03 ? 1 : 0;
    }
    CHECK(steady > 10);  // far from the highlight nothing is traced anew
    CHECK(steep > 5);
}

TEST_CASE("highlights: the farther from the light's image, the longer colour holds") {
    double last = 0;
    for (const double off : {0.0, 0.1, 0.2, 0.4, 0.8}) {
        const double turn = steady_turn(off, 0.0025, 2);
        if (off > 0.1) CHECK(turn >= last);
        last = turn;
    }
    CHECK(last == 0.8);
    CHECK(steady_turn(0.05, 0.0025, 2) < 0.05);
    CHECK(steady_turn(0.05, 0.25, 0.02) > 0.2);  // a broad lobe changes slowly
}
