#include "core/virtual_source/projection.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

LightSource lamp(const Vec3& center, double radius) {
    LightSource source;
    source.center = center;
    source.u = {kSphereBox * radius, 0, 0};
    source.v = {0, kSphereBox * radius, 0};
    source.w = {0, 0, kSphereBox * radius};
    source.radius = static_cast<float>(radius);
    source.size = static_cast<float>(kPi * radius * radius);
    return source;
}

LightSource sun(const Vec3& direction, double angle_degrees) {
    LightSource source;
    source.shape = PrimitiveType::source;
    source.center = normalize(direction);
    source.size = static_cast<float>(2 * kPi * (1 - std::cos(angle_degrees * kPi / 360)));
    source.radius = std::sqrt(source.size / static_cast<float>(kPi));
    return source;
}

constexpr Plane kWall{{-1, 0, 0}, -4};  // x = 4, facing the origin

void check_near(const Vec3& a, const Vec3& b) {
    CAPTURE(a.x);
    CAPTURE(a.y);
    CAPTURE(a.z);
    CHECK(length(a - b) < kRounding);
}

}  // namespace

TEST_CASE("mirror: points, vectors and normals are reflected, twice is nothing") {
    const Projection mirror = Projection::mirror(kWall);
    check_near(mirror.point({0, 0, 3}), {8, 0, 3});
    check_near(mirror.point({4, 7, 3}), {4, 7, 3});
    check_near(mirror.vector({1, 2, 3}), {-1, 2, 3});
    const Vec3 p{0.3, -2, 5};
    check_near(mirror.point(mirror.point(p)), p);
    const LightSource virtual_sun = project(sun({1, 0, 1}, 0.5), mirror);
    check_near(virtual_sun.center, normalize(Vec3{-1, 0, 1}));
}

TEST_CASE("mirror: only sources that reach before it") {
    CHECK(is_before_mirror(lamp({0, 0, 0}, 0.5), kWall));
    CHECK_FALSE(is_before_mirror(lamp({6, 0, 0}, 0.5), kWall));
    const Plane at_origin{{-1, 0, 0}, 0};
    CHECK(is_before_mirror(lamp({0.4, 0, 0}, 0.5), at_origin));  // its near side sticks out
    CHECK_FALSE(is_before_mirror(lamp({0.6, 0, 0}, 0.5), at_origin));
    // Elsewhere Radiance's rule loses the image of a lamp that is sunk into the mirror.
    CHECK_FALSE(is_before_mirror(lamp({4.4, 0, 0}, 0.5), kWall));
    CHECK(is_before_mirror(sun({-1, 0, 3}, 0.5), kWall));
    CHECK_FALSE(is_before_mirror(sun({1, 0, 3}, 0.5), kWall));
}

TEST_CASE("prism: light bent at the plane seems to come from the projected source") {
    const Plane sheet{{0, 0, 1}, 3};
    const Vec3 source{0, 0, 6}, at_sheet{0, 0, 3}, bent = Vec3{-0.3, 0, -1};
    const auto projection = Projection::bend(sheet, at_sheet - source, bent);
    REQUIRE(projection);
    check_near(projection->point(source), {0.9, 0, 6});
    check_near(projection->point(at_sheet), at_sheet);
    // Lengths of the directions do not matter.
    const auto same = Projection::bend(sheet, (at_sheet - source) * 5.0, bent * 0.1);
    REQUIRE(same);
    check_near(same->point(source), {0.9, 0, 6});
    // Thrown back: the source appears on the other side, like in a mirror.
    const auto back = Projection::bend(sheet, at_sheet - source, Vec3{-0.3, 0, 1});
    REQUIRE(back);
    CHECK(back->point(source).z == rounded(0));
    CHECK_FALSE(Projection::bend(sheet, {0, 0, -1}, {0, 0, -2}));    // nothing changes
    CHECK_FALSE(Projection::bend(sheet, {0, 0, -1}, {1, 0, 1e-9}));  // along the sheet
}

TEST_CASE("redirecting disks: a polygon's vertices, a ring's outline, nothing else") {
    PolygonShape square;
    const std::array<double, 12> corners{0, 0, 2, 2, 0, 2, 2, 2, 2, 0, 2, 2};
    square.vertices = PointList(std::span<const double>(corners));
    square.normal = {0, 0, 1};
    square.offset = 2;
    const auto disk = redirecting_disk(Shape{square});
    REQUIRE(disk);
    check_near(disk->center, {1, 1, 2});
    CHECK(disk->radius == rounded(std::sqrt(2.0)));
    const auto ring = redirecting_disk(Shape{RingShape{{1, 2, 3}, {0, 0, 1}, 0.5, 2}});
    REQUIRE(ring);
    CHECK(ring->radius == 2);
    CHECK_FALSE(redirecting_disk(Shape{SphereShape{{}, 1}}));
    CHECK_FALSE(plane_of(Shape{SphereShape{{}, 1}}));
}

TEST_CASE("a lamp seen through a mirror shines through it only: a cone around its disk") {
    const Projection mirror = Projection::mirror(kWall);
    const LightSource parent = lamp({0, 0, 0}, 0.1), made = project(parent, mirror);
    const VirtualSpot redirected = virtual_spot(parent, made, mirror, {{4, 0, 0}, 1});
    REQUIRE(redirected.possible);
    REQUIRE(redirected.spot);
    check_near(redirected.spot->aim, {-1, 0, 0});
    const double sine = 1.1 / 4;
    CHECK(redirected.spot->size == rounded(2 * kPi * (1 - std::sqrt(1 - sine * sine))));
    // So near that there is no bound.
    const LightSource close = lamp({3.5, 0, 0}, 0.1);
    const VirtualSpot unbounded =
        virtual_spot(close, project(close, mirror), mirror, {{4, 0, 0}, 1});
    CHECK(unbounded.possible);
    CHECK_FALSE(unbounded.spot);
    // A glow does not reach beyond its radius.
    LightSource glow = parent;
    glow.material_type = PrimitiveType::glow;
    glow.proximity = 3.9f;
    CHECK_FALSE(virtual_spot(glow, project(glow, mirror), mirror, {{4, 0, 0}, 1}).possible);
}

TEST_CASE("a virtual spotlight: its cone is reflected and meets the mirror's") {
    const Projection mirror = Projection::mirror(kWall);
    LightSource parent = lamp({0, 0, 0}, 0.01);
    parent.spot = SpotShape{{1, 0, 0}, 0.01f, 0.5f, false};
    const VirtualSpot redirected =
        virtual_spot(parent, project(parent, mirror), mirror, {{4, 0, 0}, 1});
    REQUIRE(redirected.possible);
    REQUIRE(redirected.spot);
    check_near(redirected.spot->aim, {-1, 0, 0});
    CHECK(redirected.spot->size == rounded(0.01f));
    CHECK(redirected.spot->focal_length == 0.5f);
    CHECK(redirected.disk.radius < 0.5);
    parent.spot->aim = {0, 1, 0};  // shines past the mirror
    CHECK_FALSE(virtual_spot(parent, project(parent, mirror), mirror, {{4, 0, 0}, 1}).possible);
}

TEST_CASE("redirected sunlight is a beam, a second surface cuts it") {
    const Projection mirror = Projection::mirror(kWall);
    const LightSource parent = sun({-1, 0, 0}, 0.5), made = project(parent, mirror);
    const VirtualSpot first = virtual_spot(parent, made, mirror, {{4, 0, 0}, 1});
    REQUIRE(first.spot);
    CHECK(first.spot->beam);
    CHECK(first.spot->size == rounded(kPi));
    LightSource redirected = made;
    redirected.parent = 0;
    redirected.spot = first.spot;
    const Plane opposite{{1, 0, 0}, -4};
    const Projection second = Projection::mirror(opposite);
    const VirtualSpot cut =
        virtual_spot(redirected, project(redirected, second), second, {{-4, 1.2, 0}, 1});
    REQUIRE(cut.spot);
    CHECK(cut.spot->size < first.spot->size);
    CHECK(cut.spot->aim.y > 0);
    CHECK_FALSE(
        virtual_spot(redirected, project(redirected, second), second, {{-4, 9, 0}, 1}).possible);
}
