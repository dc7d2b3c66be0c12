#include "core/cloud/reuse.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/math/random.h"

using namespace lightwalk;

namespace {

constexpr int kSide = 16;

/// Looks along y at a wall; a pixel of the wall, four metres away, is a quarter of a metre wide.
View wall_view() {
    View view;
    view.horizontal = view.vertical = 2 * std::atan(0.5) * 180 / kPi;
    return view;
}

struct Wall {
    Camera camera{wall_view()};
    PointProjector projector{camera, kSide, kSide};
    CloudGrids grids{PixelRectangle{0, 0, kSide, kSide}};
    std::vector<CloudPoint> points;
    std::vector<ImagePlace> places;
    ReuseRules rules;

    /// What the ray through (x, y) [pixels] sees of a surface `distance` away.
    [[nodiscard]] PixelVisibility visibility(double x, double y, std::uint32_t surface,
                                             double distance = 4) const {
        PixelVisibility s;
        const auto ray = camera.ray(x / kSide, y / kSide);
        s.ray = true;
        s.direction = ray->direction;
        s.x = static_cast<float>(x);
        s.y = static_cast<float>(y);
        s.ahead.seen = true;
        s.ahead.position = ray->origin + ray->direction * distance;
        s.ahead.distance = static_cast<float>(distance);
        s.ahead.surface = surface;
        return s;
    }

    void add(double x, double y, std::uint32_t surface, float light, double distance = 4) {
        const PixelPoints left =
            points_of({visibility(x, y, surface, distance), Rgb::grey(light), {}, 0}, 0.05);
        points.insert(points.end(), left.points.begin(), left.points.begin() + left.count);
    }

    PointFinder project() {
        places.resize(points.size());
        project_points(projector, points, 0, points.size(), grids, places);
        return {projector, points, grids, places, rules};
    }
};

}  // namespace

TEST_CASE("cloud: a point of the pixel's own surface and place answers it") {
    Wall wall;
    wall.add(5.4, 5.6, 1, 3);
    const PointFinder finder = wall.project();
    const PixelAnswer answer = finder.checked({5, 5}, wall.visibility(5.5, 5.5, 1));
    REQUIRE(answer.found());
    CHECK(answer.radiance.g == 3);
    CHECK(finder.distance(answer) == doctest::Approx(4));
    CHECK(static_cast<double>(answer.apart) == doctest::Approx(std::hypot(0.1, 0.1)).epsilon(1e-4));
}

TEST_CASE("reuse: pixels checked together get the answers that each gets alone") {
    Wall wall;
    RandomStream random(11);
    for (int i = 0; i < 200; ++i)
        wall.add(kSide * random.next(), kSide * random.next(), 1 + (i % 3 == 0), 1.0f);
    const PointFinder finder = wall.project();
    std::vector<PixelPlace> pixels;
    std::vector<PixelVisibility> visibility;
    for (int i = 0; i < 100; ++i) {
        pixels.push_back({i % kSide, i / kSide});
        visibility.push_back(wall.visibility(pixels.back().x + 0.5, pixels.back().y + 0.5, 1));
    }
    std::vector<PixelAnswer> answers(pixels.size());
    finder.checked(pixels, visibility, answers);
    std::size_t found = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const PixelAnswer one = finder.checked(pixels[i], visibility[i]);
        CHECK(answers[i].cause == one.cause);
        CHECK(answers[i].ahead == one.ahead);
        CHECK(answers[i].apart == one.apart);
        found += one.found();
    }
    CHECK(found > 10);
    CHECK(found < 90);
}

TEST_CASE("cloud: no point of another surface, or of another depth, shows through") {
    Wall wall;
    wall.add(5.5, 5.5, 1, 3);
    const PointFinder finder = wall.project();
    CHECK(finder.checked({5, 5}, wall.visibility(5.5, 5.5, 2)).cause == TraceCause::hidden);
    CHECK(finder.checked({5, 5}, wall.visibility(5.5, 5.5, 1, 3)).cause == TraceCause::hidden);
    CHECK(finder.checked({9, 9}, wall.visibility(9.5, 9.5, 1)).cause == TraceCause::uncovered);
}

TEST_CASE("cloud: a leaf of the same tree is a guess, one of another tree is none") {
    constexpr std::uint32_t kLeaf = 0x11101, kOther = 0x22201, kStone = 0x11102;
    Wall wall;
    wall.add(5.5, 5.5, kLeaf, 3);
    const PointFinder finder = wall.project();
    const auto guessed = [&](std::uint32_t surface, double distance) {
        const PixelAnswer answer =
            finder.checked({5, 5}, wall.visibility(5.5, 5.5, surface, distance));
        CHECK_FALSE(answer.found());
        return finder.is_guess(answer) && answer.radiance.g == 3;
    };
    CHECK(guessed(kOther, 4));
    CHECK(guessed(kOther, 5));
    CHECK_FALSE(guessed(kOther, 6));
    CHECK_FALSE(guessed(kStone, 4));
}

TEST_CASE("cloud: a pixel between points is answered where these agree, and traced where not") {
    for (const bool edge : {false, true}) {
        CAPTURE(edge);
        Wall wall;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                if (x == 5 && y == 5) continue;  // the gap
                wall.add(x + 0.5, y + 0.5, 1, edge && x > 5 ? 2.0f : 1.0f);
            }
        }
        const PixelVisibility visibility = wall.visibility(5.5, 5.5, 1);
        wall.rules.near = 0.7f;
        CHECK(wall.project().checked({5, 5}, visibility).cause ==
              (edge ? TraceCause::uneven : TraceCause::none));
        wall.rules.look_back = false;
        CHECK(wall.project().checked({5, 5}, visibility).cause == TraceCause::uncovered);
    }
}

TEST_CASE(
    "cloud: the less the points around a pixel differ, the farther they may lie from its ray") {
    Wall wall;
    wall.rules.reach = 1.5f;
    wall.rules.contrast = 0.1f;
    const auto answered = [&](double distance, float light) {
        wall.points.clear();
        for (const double x : {-1.0, 0.0, 1.0}) wall.add(5.5 + x, 5.5 + distance, 1, 1);
        wall.points.back().radiance = Rgb::grey(light);
        return wall.project().checked({5, 5}, wall.visibility(5.5, 5.5, 1)).found();
    };
    CHECK(answered(1.4, 1));
    CHECK(answered(1.1, 0.7f));
    CHECK_FALSE(answered(1.4, 0.7f));
    CHECK(answered(0.99, 0.1f));
    CHECK_FALSE(answered(1.1, 0.1f));
}

TEST_CASE("cloud: between points that lie around a pixel it shows what lies between them") {
    Wall wall;
    const auto between = [&](double left, double right) {
        wall.points.clear();
        wall.add(5.5 - left, 5.5, 1, 1);
        wall.add(5.5 + right, 5.5, 1, 2);
        const PixelAnswer answer = wall.project().checked({5, 5}, wall.visibility(5.5, 5.5, 1));
        REQUIRE(answer.found());
        return static_cast<double>(answer.radiance.g);
    };
    CHECK(between(0.8, 0.8) == doctest::Approx(1.5).epsilon(1e-5));
    CHECK(between(0.8, 1.2) < 1.3);
    CHECK(between(0.8, 1.2) > 1);
    CHECK(between(0.6, 0.8) == 1);  // so near a point shows the pixel as it is
}

TEST_CASE("cloud: a reflection that brings next to nothing may be of anything") {
    for (const float light : {0.04f, 0.2f}) {
        CAPTURE(light);
        Wall wall;
        TracedPixel pixel{wall.visibility(8.5, 8.5, 1), Rgb::grey(1 + light), Rgb::grey(light), 4};
        pixel.visibility.mirrored = pixel.visibility.ahead;
        pixel.visibility.mirrored.kind = PointKind::mirrored;
        const PixelPoints left = points_of(pixel, 0.05);
        wall.points.assign(left.points.begin(), left.points.end());
        PixelVisibility moved = pixel.visibility;
        moved.mirrored.surface = 78;
        CHECK(wall.project().checked({8, 8}, moved).found() == (light < 0.05f));
        moved.ahead.surface = 78;  // what lies ahead is never faint
        CHECK(!wall.project().checked({8, 8}, moved).found());
    }
}

TEST_CASE("cloud: a point on the pixel itself answers it wherever its ray goes through it") {
    Wall wall;
    wall.add(5.05, 5.05, 1, 3);
    wall.add(6.1, 5.95, 1, 1);  // nearer to the ray, but of the pixel beside it
    const PixelAnswer answer = wall.project().checked({5, 5}, wall.visibility(5.95, 5.95, 1));
    REQUIRE(answer.found());
    CHECK(answer.ahead == 0);
}

TEST_CASE(
    "cloud: a view-dependent point holds until the view has turned as far as its slope allows") {
    Wall wall;
    TracedPixel pixel{wall.visibility(8.5, 8.5, 1), Rgb::grey(1), {}, 4};
    pixel.visibility.ahead.slope = 2;  // 5 % of the colour in 0.025 rad
    const PixelPoints left = points_of(pixel, 0.05);
    REQUIRE(left.count == 1);
    const CloudPoint& point = left.points[0];
    CHECK(static_cast<double>(point.max_view_angle) == doctest::Approx(0.025));
    const Vec3 d = pixel.visibility.direction, side = perpendicular(d);
    CHECK(holds_from(point, normalize(d + side * 0.024), 1));
    CHECK(!holds_from(point, normalize(d + side * 0.026), 1));
    CHECK(!holds_from(point, normalize(d + side * 0.024), 0.5));
    wall.points.push_back(point);
    PixelVisibility turned = pixel.visibility;
    turned.direction = normalize(d + side * 0.03);
    CHECK(wall.project().checked({8, 8}, turned).cause == TraceCause::turned);
    CHECK(wall.project().checked({8, 8}, pixel.visibility).found());
}

TEST_CASE(
    "cloud: a pixel with a reflection is the sum of two points, and lacks both if it lacks one") {
    Wall wall;
    TracedPixel pixel{wall.visibility(8.5, 8.5, 1), Rgb::grey(3), Rgb::grey(1), 4};
    pixel.visibility.mirrored = pixel.visibility.ahead;
    pixel.visibility.mirrored.kind = PointKind::mirrored;
    pixel.visibility.mirrored.surface = 77;
    pixel.visibility.mirrored.distance = 9;
    pixel.visibility.mirrored.position = pixel.visibility.direction * 9;
    PixelPoints left = points_of(pixel, 0.05);
    REQUIRE(left.count == 2);
    CHECK(left.points[0].radiance.g == 2);
    CHECK(left.points[1].radiance.g == 1);
    CHECK((left.points[0].paired && left.points[1].paired));
    wall.points.assign(left.points.begin(), left.points.end());
    {
        const PointFinder finder = wall.project();
        const PixelAnswer answer = finder.checked({8, 8}, pixel.visibility);
        REQUIRE(answer.found());
        CHECK(answer.radiance.g == 3);
        CHECK(finder.distance(answer) == doctest::Approx(4));
        CHECK(finder.unchecked({8, 8}).found());
        PixelVisibility moved = pixel.visibility;
        moved.mirrored.surface = 78;  // something else is in the mirror
        CHECK(finder.checked({8, 8}, moved).cause == TraceCause::hidden);
    }
    {
        wall.points[1].radiance = Rgb::grey(5);  // it shows the reflection more than the surface
        const PointFinder finder = wall.project();
        CHECK(finder.distance(finder.checked({8, 8}, pixel.visibility)) == doctest::Approx(9));
    }
    pixel.visibility.mirrored.slope = kNeverReuse;
    CHECK(points_of(pixel, 0.05).count == 0);
    CHECK(wall.project().checked({8, 8}, pixel.visibility).cause == TraceCause::never_reused);
}

TEST_CASE("cloud: without rays, points that show through a gap or stand alone are dropped") {
    Wall wall;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x)
            wall.add(x + 0.5, y + 0.5, 1, 1, x == 5 && y == 5 ? 8 : x == 9 && y == 9 ? 2 : 4);
    }
    CHECK(wall.project().unchecked({5, 5}).cause == TraceCause::hidden);  // behind the wall
    CHECK(wall.project().unchecked({9, 9}).cause == TraceCause::hidden);  // alone before it
    CHECK(wall.project().unchecked({12, 12}).found());
    const auto unverified = [&](const PixelPlace& pixel) {
        const PointFinder& finder = wall.project();
        PixelAnswer found;
        finder.unverified(finder.square_of(pixel), {&pixel, 1}, {&found, 1});
        return found;
    };
    CHECK(unverified({5, 5}).cause == TraceCause::hidden);
    CHECK(unverified({9, 9}).found());
    CHECK(unverified({12, 12}).radiance.g == 1);
    wall.rules.drop_lonely = false;
    CHECK(wall.project().unchecked({9, 9}).found());
    CHECK(wall.project().unchecked({5, 5}).cause == TraceCause::hidden);
    wall.rules.drop_hidden = false;
    CHECK(wall.project().unchecked({5, 5}).found());
    CHECK(wall.project().is_edge({4, 5}));
    CHECK(wall.project().is_edge({0, 7}));
    CHECK(!wall.project().is_edge({12, 12}));
    for (const int x : {12, 13})
        wall.points[static_cast<std::size_t>(12 * kSide + x)].kind = PointKind::gone;
    wall.add(13.1, 12.5, 1, 3);
    wall.grids.ahead.clear(0, wall.grids.ahead.size());
    CHECK(unverified({12, 12}).radiance.g == 3);  // the nearest one around
}

TEST_CASE(
    "cloud: without a ray the midst of a surface is inferred from the last frame, what may hide "
    "something is not") {
    Wall wall;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) wall.add(x + 0.5, y + 0.5, 1, 1);
    const auto point = [&](int x, int y) -> CloudPoint& {
        return wall.points[static_cast<std::size_t>(y * kSide + x)];
    };
    const auto answer = [&] {
        wall.grids.ahead.clear(0, wall.grids.ahead.size());
        const PixelPlace pixel{5, 5};
        PixelAnswer found;
        const PointFinder& finder = wall.project();
        finder.temporal(finder.square_of(pixel), {&pixel, 1}, {&found, 1});
        return found;
    };
    REQUIRE(answer().found());
    CHECK(answer().radiance.g == 1);
    CHECK(answer().ahead == 5 * kSide + 5);
    SUBCASE("a depth that steps") {
        wall.add(6.5, 5.5, 2, 1, 3.5);
        CHECK(!answer().found());
    }
    SUBCASE("a pixel whose light is a sum") {
        point(5, 5).paired = true;
        CHECK(!answer().found());
    }
    SUBCASE("something mirrored") {
        wall.points.push_back(point(5, 5));
        wall.points.back().kind = PointKind::mirrored;
        CHECK(!answer().found());
    }
    SUBCASE("a colour seen from elsewhere") {
        point(5, 5).max_view_angle = 0.01f;
        CHECK(answer().found());
        point(5, 5).direction = encode_direction({1, 0, 0});
        CHECK(!answer().found());
    }
    SUBCASE(
        "a point that the last frame did not show, with others around that it did, or without") {
        point(5, 5).age = 1;
        CHECK(answer().found());
        for (CloudPoint& other : wall.points) other.age = 1;
        CHECK(!answer().found());
    }
    SUBCASE("no point of its own, but around it, of one surface or two") {
        point(5, 5).kind = PointKind::gone;
        CHECK(answer().found());
        CHECK(answer().radiance.g == 1);
        point(4, 5).surface = 2;
        CHECK(!answer().found());
    }
    SUBCASE("too few points around") {
        for (int x = 4; x <= 6; ++x) point(x, 4).kind = PointKind::gone;
        CHECK(answer().found());
        for (int x = 4; x <= 6; ++x) point(x, 6).kind = PointKind::gone;
        CHECK(!answer().found());
    }
}
