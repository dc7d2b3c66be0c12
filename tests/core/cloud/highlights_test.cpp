#include "core/cloud/highlights.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/cloud/visibility_probe.h"
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
    return Highlights(scene.tracer.lights(), scene.scene.geometry(), scene.tracer.options())
        .slope(hit, -away, {.05, .95 * .4, .08});
}

}  // namespace

TEST_CASE("highlights: where the slope says that colour holds for a turn, it does") {
    TestScene scene(kFloor);
    int steady = 0, steep = 0;
    for (double angle = 0.1; angle < kPi / 2; angle += 0.01) {
        CAPTURE(angle);
        const double slope = slope_at(scene, angle);
        const double turn = slope > 0 ? 0.1 / slope : 0.8;
        const double here = seen_at(scene, angle);
        for (const double there : {angle + turn, angle - turn, angle + turn / 2}) {
            if (there < 0.05 || there > kPi - 0.05) continue;
            CHECK(std::abs(seen_at(scene, there) - here) <= 0.101 * here);
        }
        steady += turn >= 0.2 ? 1 : 0;
        steep += turn <= 0.03 ? 1 : 0;
    }
    CHECK(steady > 10);  // far from the highlight nothing is traced anew
    CHECK(steep > 5);
}

TEST_CASE("highlights: a light that is hidden does not shine") {
    const TestScene open(kFloor);
    const TestScene hidden(kFloor + "satin polygon wall 0 0 12  -9 2 0  9 2 0  9 2 9  -9 2 9\n");
    const double mirrored = kPi / 4;  // where the lamp's image is
    CHECK(slope_at(open, mirrored + 0.1) > 1);
    CHECK(slope_at(hidden, mirrored + 0.1) == 0);
}

TEST_CASE("highlights: within the image of a window colour is steadier than at its edge") {
    const TestScene window(R"(
void plastic satin 0 0 5 .4 .4 .4 .05 .02
void light pane 0 0 3 1 1 1
satin polygon floor 0 0 12  -50 -50 0  50 -50 0  50 50 0  -50 50 0
pane polygon window 0 0 12  -4 4 2  4 4 2  4 4 6  -4 4 6
)");
    const double lower = std::atan2(2.0, 4.0), upper = std::atan2(6.0, 4.0);
    CHECK(slope_at(window, (lower + upper) / 2) < slope_at(window, upper));
    CHECK(slope_at(window, (lower + upper) / 2) < slope_at(window, lower));
}
