#include "core/cloud/between.h"

#include <doctest/doctest.h>

#include <array>

using namespace lightwalk;

namespace {

/// What a ray through (x, y) sees of the plane z = -1 - slope x, the eye being at the origin.
PixelSights of_plane(double x, double y, double slope) {
    PixelSights sights;
    sights.ray = true;
    sights.direction = normalize(Vec3{x, y, -1});
    sights.ahead.seen = true;
    sights.ahead.surface = 5;
    const Vec3 along{x, y, -1};
    sights.ahead.position = along * (1 / (1 - slope * x));
    sights.ahead.distance = static_cast<float>(length(sights.ahead.position));
    return sights;
}

}  // namespace

TEST_CASE("between pixels that see one plane lies what the pixel between them sees") {
    for (const double slope : {0.0, 0.5, 2.0}) {
        const double step = 0.002, x = 0.1, y = 0.05;
        const std::array around{of_plane(x - step, y, slope), of_plane(x + step, y, slope),
                                of_plane(x, y - step, slope), of_plane(x, y + step, slope)};
        const std::array<const PixelSights*, 4> pairs{&around[0], &around[1], &around[2],
                                                      &around[3]};
        for (const PixelSights* one : pairs) REQUIRE(see_alike(*pairs[0], *one));
        const PixelSights between = sights_between(pairs, {7, 9});
        const PixelSights truth = of_plane(x, y, slope);
        CHECK(length(between.ahead.position - truth.ahead.position) <
              1e-4 * length(truth.ahead.position));
        CHECK(between.ahead.distance == doctest::Approx(truth.ahead.distance).epsilon(1e-4));
        CHECK(length(between.direction - truth.direction) < 1e-5);
        CHECK(between.ahead.surface == 5);
        CHECK(between.x == 7.5f);
        CHECK(between.y == 9.5f);
        CHECK_FALSE(between.mirrored.seen);
    }
}

TEST_CASE("pixels do not see alike where anything differs") {
    const PixelSights one = of_plane(0, 0, 0);
    const auto differs = [&](auto change) {
        PixelSights other = one;
        change(other);
        return !see_alike(one, other) && !see_alike(other, one);
    };
    CHECK(see_alike(one, one));
    CHECK(differs([](PixelSights& s) { s.ray = false; }));
    CHECK(differs([](PixelSights& s) { s.ahead.seen = false; }));
    CHECK(differs([](PixelSights& s) { s.ahead.surface = 6; }));
    CHECK(differs([](PixelSights& s) { s.ahead.kind = PointKind::through; }));
    CHECK(differs([](PixelSights& s) { s.ahead.slope = kUnsteady; }));
    CHECK(differs([](PixelSights& s) { s.ahead.distance *= 1.2f; }));
    CHECK(differs([](PixelSights& s) { s.mirrored.seen = true; }));
}
