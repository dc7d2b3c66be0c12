#include "core/light/spot.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

SpotShape cone(const Vec3& aim, double half_angle_degrees, float focal_length = 0) {
    return {normalize(aim),
            static_cast<float>(cone_solid_angle(std::cos(half_angle_degrees * kPi / 180))),
            focal_length, false};
}

double half_angle(const SpotShape& spot) {
    return std::acos(1 - static_cast<double>(spot.size) / (2 * kPi)) * 180 / kPi;
}

}  // namespace

TEST_CASE("a cone holds the rays that come from within its half angle") {
    const SpotShape spot = cone({0, 0, -1}, 20);
    for (const double angle : {0.0, 10.0, 19.9, 20.1, 90.0, 180.0}) {
        CAPTURE(angle);
        const double a = angle * kPi / 180;
        CHECK(outside_spot(spot, {}, {std::sin(a), 0, std::cos(a)}) == (angle > 20));
    }
}

TEST_CASE("a beam holds the origins within its cross-section, wherever they are along it") {
    const SpotShape beam{{1, 0, 5}, static_cast<float>(kPi * 4), 0, true};  // radius 2
    for (const double z : {-3.0, 5.0, 40.0}) {
        CHECK_FALSE(outside_spot(beam, {2.9, 0, z}, {0, 0, 1}));
        CHECK(outside_spot(beam, {3.1, 0, z}, {0, 0, 1}));
    }
}

TEST_CASE("a flat spotlight must shine to its front at least in part") {
    CHECK(spot_faces(cone({0, 0, 1}, 10), {0, 0, 1}));
    CHECK(spot_faces(cone({1, 0, 0.1}, 1), {0, 0, 1}));
    CHECK(spot_faces(cone({1, 0, 0}, 10), {0, 0, 1}));
    CHECK(spot_faces(cone({1, 0, -std::tan(9 * kPi / 180)}, 10), {0, 0, 1}));
    CHECK_FALSE(spot_faces(cone({1, 0, -std::tan(11 * kPi / 180)}, 10), {0, 0, 1}));
    CHECK_FALSE(spot_faces(cone({0, 0, -1}, 80), {0, 0, 1}));
    CHECK(spot_faces(cone({0, 0, -1}, 100), {0, 0, 1}));
}

TEST_CASE("disks: contained, crossing and apart") {
    const Disk a{{0, 0, 0}, 1}, small{{0.5, 0, 0}, 0.04}, b{{1, 0, 0}, 1};
    const auto inner = intersect_disks(a, small, small.center);
    REQUIRE(inner);
    CHECK(inner->center == small.center);
    CHECK(inner->radius_squared == 0.04);
    const auto lens = intersect_disks(a, b, b.center);
    REQUIRE(lens);
    CHECK(lens->radius_squared == rounded(0.75));  // half chord of two unit circles one apart
    CHECK(lens->center.x == rounded(0.5));
    CHECK_FALSE(intersect_disks(a, b, {2.1, 0, 0}));
}

TEST_CASE("overlapping cones: the narrower inside, a smaller one across, none apart") {
    const SpotShape narrow = cone({0, 0, 1}, 10), wide = cone({0, 0.05, 1}, 40, 2);
    const auto inside = intersect_cones(narrow, wide);
    REQUIRE(inside);
    CHECK(half_angle(*inside) == float_rounded(10));
    CHECK(inside->focal_length == 2);
    const auto crossing =
        intersect_cones(cone({0, 0, 1}, 10), cone({std::tan(15 * kPi / 180), 0, 1}, 10));
    REQUIRE(crossing);
    CHECK(half_angle(*crossing) < 10);
    CHECK(half_angle(*crossing) > 5);
    CHECK(crossing->aim.x == float_rounded(std::sin(7.5 * kPi / 180)));
    CHECK_FALSE(intersect_cones(cone({0, 0, 1}, 10), cone({1, 0, 0}, 10)));
    // A hemisphere only has to overlap.
    const auto whole = intersect_cones(narrow, cone({0, 0, 1}, 120, 3));
    REQUIRE(whole);
    CHECK(whole->size == narrow.size);
    CHECK(whole->focal_length == 3);
    CHECK_FALSE(intersect_cones(narrow, cone({0, 0, -1}, 95)));
}

TEST_CASE("overlapping beams: as seen along their direction") {
    const SpotShape a{{0, 0, 0}, static_cast<float>(kPi), 0, true},
        b{{1, 0, 7}, static_cast<float>(kPi), 0, true};
    const auto common = intersect_beams(a, b, {0, 0, 1});
    REQUIRE(common);
    CHECK(common->size == rounded(0.75 * kPi));
    CHECK(common->aim.x == rounded(0.5));
    CHECK(common->beam);
    CHECK_FALSE(intersect_beams(a, b, {1, 0, 0}));
}
