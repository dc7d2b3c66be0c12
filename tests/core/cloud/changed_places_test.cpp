#include "core/cloud/changed_places.h"

#include <doctest/doctest.h>

using namespace lightwalk;

namespace {

CloudPoint point_at(double x, double y, double z, PointKind kind = PointKind::plain) {
    CloudPoint point;
    point.position = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    point.kind = kind;
    return point;
}

const Bounds kBox{{-.1, -.1, .9}, {.1, .1, 1.1}};
const Vec3 kEye{-5, 0, 1};

}  // namespace

TEST_CASE("changed places: what is in them, near them or seen past them is touched") {
    const ChangedPlaces places({kBox}, kEye, {});
    CHECK(places.may_touch(point_at(0, 0, 1)));
    CHECK(places.may_touch(point_at(0, .12, 1)));
    CHECK(places.may_touch(point_at(5, 0, 1)));  // behind, for the eye
    CHECK(places.may_touch(point_at(1e10, 0, 1)));
    CHECK_FALSE(places.may_touch(point_at(-4, 0, 1)));
    CHECK_FALSE(places.may_touch(point_at(0, 3, 1)));
    CHECK_FALSE(places.may_touch(point_at(5, 3, 1)));
    CHECK(places.may_touch(point_at(0, 3, 1, PointKind::mirrored)));
    CHECK_FALSE(ChangedPlaces({}, kEye, {}).may_touch(point_at(0, 3, 1, PointKind::mirrored)));
}

TEST_CASE("changed places: their shadows are touched, of near and distant sources") {
    const ChangedPlaces places({kBox}, kEye, {{{3, 3, 3}, false}, {{0, -1, 0}, true}});
    CHECK(places.may_touch(point_at(-1.5, -1.5, 0)));
    CHECK_FALSE(places.may_touch(point_at(3.5, 3.5, 3.5)));  // beyond the lamp
    CHECK_FALSE(places.may_touch(point_at(2, 2, 2)));        // before the box
    CHECK(places.may_touch(point_at(0, 50, 1)));             // the sun's
    CHECK_FALSE(places.may_touch(point_at(0, -50, 1)));
}
