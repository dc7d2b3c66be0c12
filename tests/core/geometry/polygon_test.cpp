#include "core/geometry/polygon.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/geometry/geometry_scenes.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

PolygonShape outline(std::vector<double> reals) {
    return std::get<PolygonShape>(
        make_shape(kept_primitive(PrimitiveType::polygon, std::move(reals))).shape);
}

/// An outline in the plane z = 0.
PolygonShape flat(const std::vector<std::pair<double, double>>& points) {
    std::vector<double> reals;
    for (const auto& [x, y] : points) reals.insert(reals.end(), {x, y, 0});
    return outline(reals);
}

bool inside(const PolygonShape& polygon, double x, double y) {
    return contains(polygon, {x, y, 0}, nullptr);
}

}  // namespace

TEST_CASE("a concave outline leaves its notch out") {
    const PolygonShape notched = flat({{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}});
    CHECK(inside(notched, 2, 0.9));
    CHECK_FALSE(inside(notched, 2, 1.1));
    CHECK(inside(notched, 0.5, 2));
    CHECK(inside(notched, 3.5, 2));
    CHECK_FALSE(inside(notched, 4.5, 1));
}

TEST_CASE("a rectangle along the axes holds what its four edges say, also beside them") {
    Random random(3);
    for (int turn = 0; turn < 8; ++turn) {
        // Any first corner, either way round.
        std::vector<std::pair<double, double>> corners{{1, -2}, {4.5, -2}, {4.5, 0.25}, {1, 0.25}};
        std::rotate(corners.begin(), corners.begin() + turn % 4, corners.end());
        if (turn >= 4) std::reverse(corners.begin(), corners.end());
        const PolygonShape quick = flat(corners);
        PolygonShape slow = quick;
        slow.rectangle = {};
        REQUIRE(quick.rectangle.low_x == 1);
        REQUIRE(quick.rectangle.high_y == 0.25);
        int within = 0;
        for (int i = 0; i < 20000; ++i) {
            const auto near = [&](double edge) {
                return edge + (random.below(4) == 0 ? 0 : random.uniform(-3e-6, 3e-6));
            };
            const double x =
                random.below(2) == 0 ? near(random.below(2) == 0 ? 1 : 4.5) : random.uniform(0, 6);
            const double y = random.below(2) == 0 ? near(random.below(2) == 0 ? -2 : 0.25)
                                                  : random.uniform(-3, 1);
            REQUIRE(inside(quick, x, y) == inside(slow, x, y));
            within += inside(quick, x, y) ? 1 : 0;
        }
        CHECK(within > 4000);
        CHECK(within < 16000);
    }
    CHECK(std::isnan(flat({{0, 0}, {4, 0.1}, {4, 3}, {0, 3}}).rectangle.low_x));
    CHECK(std::isnan(flat({{0, 0}, {4, 0}, {4, 3}}).rectangle.low_x));
}

TEST_CASE("a hole is open and the seam that leads to it is solid") {
    const PolygonShape frame =
        flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});
    CHECK(area_of(frame) == 12);
    CHECK_FALSE(inside(frame, 2, 2));
    CHECK(inside(frame, 0.5, 2));
    CHECK(inside(frame, 3.5, 2));
    CHECK(inside(frame, 2, 0.5));
    for (const double s : {0.1, 0.25, 0.5, 0.73}) CHECK(inside(frame, s, s));  // on the seam
    CHECK(inside(frame, 0.4, 0.5));
    // every wound the same way: even-odd does not care
    const PolygonShape same =
        flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {3, 1}, {3, 3}, {1, 3}, {1, 1}});
    CHECK_FALSE(inside(same, 2, 2));
    CHECK(inside(same, 0.5, 2));
}

TEST_CASE("a self-crossing outline follows the even-odd rule") {
    std::vector<std::pair<double, double>> star;
    star.reserve(5);
    for (int i = 0; i < 5; ++i) star.emplace_back(std::cos(0.8 * kPi * i), std::sin(0.8 * kPi * i));
    const PolygonShape pentagram = flat(star);
    CHECK_FALSE(inside(pentagram, 0, 0));
    CHECK(inside(pentagram, 0.7, 0));
    CHECK_FALSE(inside(pentagram, -0.7, 0));
}

TEST_CASE("edges count as inside, within a millionth") {
    const PolygonShape square = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    CHECK(inside(square, 0, 0.5));
    CHECK(inside(square, 1, 0.5));
    CHECK(inside(square, 0.5, 0));
    CHECK(inside(square, 0.5, 1));
    CHECK(inside(square, 0.5, 1 + 0.9e-6));
    CHECK(inside(square, 0.5, -0.9e-6));
    CHECK_FALSE(inside(square, 0.5, 1 + 1.1e-6));
    CHECK_FALSE(inside(square, 0.5, -1.1e-6));
    CHECK_FALSE(inside(square, 1 + 1.1e-6, 0.5));
}

TEST_CASE("the tested plane is the one along the normal's longest axis") {
    // the same square in three planes
    CHECK(contains(outline({5, 0, 0, 5, 1, 0, 5, 1, 1, 5, 0, 1}), {5, 0.9, 0.1}, nullptr));
    CHECK_FALSE(contains(outline({5, 0, 0, 5, 1, 0, 5, 1, 1, 5, 0, 1}), {5, 1.1, 0.1}, nullptr));
    CHECK(contains(outline({0, 5, 0, 0, 5, 1, 1, 5, 1, 1, 5, 0}), {0.9, 5, 0.1}, nullptr));
    CHECK_FALSE(contains(outline({0, 5, 0, 0, 5, 1, 1, 5, 1, 1, 5, 0}), {0.9, 5, 1.1}, nullptr));
}

TEST_CASE("the index of edges changes no answer") {
    Random random(9);
    for (int k = 0; k < 30; ++k) {
        std::vector<double> reals;
        if (k % 3 == 0) {
            reals = star_polygon(random, 200);
        } else {  // a comb: long edges; or random scribble on a grid
            for (int i = 0; i < 200; ++i) {
                const double x = k % 3 == 1 ? 0.01 * i : random.below(20),
                             y = k % 3 == 1 ? i % 2 : random.below(20);
                reals.insert(reals.end(), {x, y, 0.25});
            }
            reals.insert(reals.end(), {1, -3, 0.25});
        }
        const PolygonShape polygon = outline(reals);
        const EdgeIndex index(polygon);
        int found = 0;
        for (int i = 0; i < 400; ++i) {
            Vec3 p{reals[0], reals[1], reals[2]};
            if (i % 4 == 0)
                p = polygon.vertices[static_cast<std::size_t>(random.below(200))];
            else
                p += random.in_box(3);
            p += polygon.normal * (polygon.offset - dot(polygon.normal, p));
            const bool expected = contains(polygon, p, nullptr);
            CHECK(contains(polygon, p, &index) == expected);
            found += expected ? 1 : 0;
        }
        CHECK(found > 50);
        CHECK(index.memory_bytes() < 200 * 64);
    }
}

TEST_CASE(
    "the index of edges changes no answer of small outlines, beside edges and corners either") {
    Random random(27);
    int inside_count = 0, on_edge = 0;
    for (int k = 0; k < 3000; ++k) {
        const double size = std::pow(10, random.uniform(-6.5, 2));
        std::vector<std::pair<double, double>> corners;
        for (int i = 0; i < 3 + k % 4; ++i) {
            corners.emplace_back(random.uniform(-size, size), random.uniform(-size, size));
            if (i > 0 && random.below(3) == 0) corners.back().second = corners[0].second;
        }
        std::vector<double> reals;
        for (const auto& [x, y] : corners) reals.insert(reals.end(), {x, y, 0});
        const auto valid = make_shape(kept_primitive(PrimitiveType::polygon, reals)).shape;
        const auto* polygon = std::get_if<PolygonShape>(&valid);
        if (!polygon) continue;  // without area
        const EdgeIndex edge_by_edge(*polygon);
        for (int i = 0; i < 100; ++i) {  // beside an edge, or the line through it
            const Vec3 a = polygon->vertices[static_cast<std::size_t>(random.below(3))],
                       b = polygon->vertices[static_cast<std::size_t>(random.below(3))];
            const double s = random.below(3) == 0 ? 0 : random.uniform(-0.5, 1.5),
                         off = i % 2 == 0 ? 3e-6 : size / 2;
            const Vec3 p = a + (b - a) * s +
                           Vec3{random.uniform(-off, off),
                                random.below(4) == 0 ? 0 : random.uniform(-off, off), 0};
            const bool expected = contains(*polygon, p, &edge_by_edge);
            REQUIRE(contains(*polygon, p, nullptr) == expected);
            inside_count += expected ? 1 : 0;
            on_edge += expected && i % 2 == 0 ? 1 : 0;
        }
    }
    CHECK(inside_count > 60'000);
    CHECK(on_edge > 30'000);
}

TEST_CASE("an outline of a million vertices is built and hit in no time") {
    std::vector<double> reals;
    constexpr int kCount = 1'000'000;
    reals.reserve(std::size_t{3} * kCount);
    for (int i = 0; i < kCount; ++i) {
        const double angle = 2 * kPi * i / kCount, r = 1 + 0.1 * (i % 2);
        reals.insert(reals.end(), {r * std::cos(angle), r * std::sin(angle), 0});
    }
    TestModels scene;
    scene.add(surface(PrimitiveType::polygon, std::move(reals), 0, kOpaque));
    const BuiltGeometry geometry = scene.build();
    Random random(1);
    for (int i = 0; i < 10000; ++i) {  // one by one through all edges this would take a minute
        const double x = random.uniform(-2, 2), y = random.uniform(-2, 2), r = std::hypot(x, y);
        const bool hit = geometry.intersect({{x, y, 1}, {0, 0, -1}}).exists();
        if (r < 0.999) CHECK(hit);
        if (r > 1.101) CHECK_FALSE(hit);
    }
}

TEST_CASE("a polygon edge-on is missed") {
    const Shape square =
        make_shape(kept_primitive(PrimitiveType::polygon, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}))
            .shape;
    CHECK_FALSE(intersect(square, {-1, 0.5, 1e-6}, normalize(Vec3{1, 0, -0.99e-6}), kHuge));
    CHECK(intersect(square, {-1, 0.5, 2e-6}, normalize(Vec3{1, 0, -1.5e-6}), kHuge));
}
