#include "core/glare/outline.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/glare/visual_field.h"
#include "tests/core/glare/fisheye_picture.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using test::direction_of;
using test::fisheye_view;
using test::LightDisc;
using test::within;

namespace {

constexpr int kOutlineSize = 400;
constexpr double kPixel = kPi / kOutlineSize;  ///< of an angular fisheye [rad]

/// The pixels of a fisheye for which a predicate of directions holds.
template <class Shows>
std::vector<PixelPlace> places_where(const Camera& camera, const Shows& shows) {
    std::vector<PixelPlace> places;
    for (int y = 0; y < kOutlineSize; ++y) {
        for (int x = 0; x < kOutlineSize; ++x) {
            const auto ray = camera.ray((x + 0.5) / kOutlineSize, (y + 0.5) / kOutlineSize);
            if (ray && ray->direction.y >= 0 && shows(ray->direction)) places.push_back({x, y});
        }
    }
    return places;
}

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

/// The solid angle inside a polygon that its centre sees all of.
double solid_angle_in(const std::vector<Vec3>& outline, const Vec3& centre) {
    double sum = 0;
    for (std::size_t i = 0; i < outline.size(); ++i)
        sum += triangle_solid_angle(centre, outline[i], outline[(i + 1) % outline.size()]);
    return sum;
}

}  // namespace

TEST_CASE("outline: of a disc runs along its edge, wherever it is seen") {
    const Camera camera(fisheye_view('a'));
    for (const LightDisc& disc : {LightDisc{0, 0, 10, 0}, {40, 30, 6, 0}, {-60, -20, 15, 0}}) {
        const Vec3 centre = direction_of(disc);
        const double radius = disc.radius * kPi / 180;
        const auto outline = outline_of(
            places_where(camera, [&](const Vec3& d) { return angle_between(d, centre) <= radius; }),
            camera, kOutlineSize, kOutlineSize);
        CHECK(outline.size() >= 8);
        CHECK(outline.size() <= 64);
        for (const Vec3& p : outline) {
            CHECK(length(p) == test::rounded(1));
            CHECK(std::abs(angle_between(p, centre) - radius) < kPixel);
        }
        // An edge that is off by a pixel all around.
        CHECK(solid_angle_in(outline, centre) ==
              within(2 * kPixel / radius, 2 * kPi * (1 - std::cos(radius))));
        Vec3 turn;  // counterclockwise as the eye sees it: clockwise about the line of sight
        for (std::size_t i = 0; i < outline.size(); ++i)
            turn += cross(outline[i], outline[(i + 1) % outline.size()]);
        CHECK(dot(turn, centre) < 0);
    }
}

TEST_CASE("outline: of a window has few corners, whose edges are straight in a perspective") {
    const Camera camera(fisheye_view('a'));
    const auto outline = outline_of(places_where(camera,
                                                 [](const Vec3& d) {
                                                     return d.x / d.y > 0.5 && d.x / d.y < 2 &&
                                                            d.z / d.y > 0.2 && d.z / d.y < 1.5;
                                                 }),
                                    camera, kOutlineSize, kOutlineSize);
    CHECK(outline.size() >= 4);
    CHECK(outline.size() <= 12);  // 4, and what the stairs of the pixels leave at the corners
    // Each corner of the window has a point of the outline: the smoothing's 1.6 pixels and the
    // pixel's own size off at most.
    for (const double x : {0.5, 2.}) {
        for (const double z : {0.2, 1.5}) {
            double nearest = kPi;
            for (const Vec3& p : outline)
                nearest = std::min(nearest, angle_between(p, normalize({x, 1, z})));
            CHECK(nearest < 3 * kPixel);
        }
    }
}

TEST_CASE("outline: of a pixel is its corners, and pieces of one source have one") {
    const Camera camera(fisheye_view('a'));
    const std::vector<PixelPlace> one{{200, 200}};
    CHECK(outline_of(one, camera, kOutlineSize, kOutlineSize).size() == 4);
    CHECK(outline_of({}, camera, kOutlineSize, kOutlineSize).empty());
    std::vector<PixelPlace> panes;
    for (int y = 180; y < 200; ++y) {
        for (int x = 180; x < 220; ++x) {
            if (x % 10 < 8) panes.push_back({x, y});  // bars of two pixels
        }
    }
    const std::vector<Vec3> outline = outline_of(panes, camera, kOutlineSize, kOutlineSize);
    // 38 x 20 pixels, each side wider by one.
    CHECK(
        solid_angle_in(outline, camera.ray(199. / kOutlineSize, 190. / kOutlineSize)->direction) ==
        within(0.05, 40 * 22 * kPixel * kPixel));
}

TEST_CASE("outline: never more points than asked for") {
    const Camera camera(fisheye_view('h'));
    const auto ragged = places_where(camera, [](const Vec3& d) {
        return std::hypot(d.x, d.z) < 0.5 + 0.3 * std::sin(25 * std::atan2(d.z, d.x));
    });
    for (const std::size_t limit : {4u, 20u, 64u}) {
        const std::vector<Vec3> outline =
            outline_of(ragged, camera, kOutlineSize, kOutlineSize, limit);
        CHECK(outline.size() <= limit);
        CHECK(outline.size() >= 4);
    }
}

TEST_CASE("outline: of a thin ragged line has an inside") {
    const Camera camera(fisheye_view('a'));
    std::vector<PixelPlace> line;
    for (int x = 50; x < 350; ++x) line.push_back({x, 200 + x / 2 % 2});
    const std::vector<Vec3> outline = outline_of(line, camera, kOutlineSize, kOutlineSize, 4);
    CHECK(outline.size() == 4);
    Vec3 turn;
    for (std::size_t i = 0; i < outline.size(); ++i)
        turn += cross(outline[i], outline[(i + 1) % outline.size()]);
    CHECK(length(turn) > kPixel);
}

TEST_CASE("outline: all that is before the eye is bounded by the plane of the eye") {
    for (const char type : {'a', 'h'}) {
        const Camera camera(fisheye_view(type));
        const auto outline = outline_of(places_where(camera, [](const Vec3&) { return true; }),
                                        camera, kOutlineSize, kOutlineSize);
        CHECK(outline.size() <= 64);
        // The rim's pixels stay inside it: in a hemispherical view by sqrt(2 pixels) of the radius.
        for (const Vec3& p : outline) CHECK(p.y < (type == 'a' ? 2 * kPixel : 0.15));
    }
}

TEST_CASE("projected outline: the places where a perspective shows the directions") {
    View view;
    view.position = {5, 6, 7};
    view.fore = 3;  // clips surfaces, not directions
    view.horizontal = 90, view.vertical = 90;
    const Camera camera(view);
    const std::vector<Vec3> square{normalize({-0.5, 1, -0.5}), normalize({0.5, 1, -0.5}),
                                   normalize({0.5, 1, 0.5}), normalize({-0.5, 1, 0.5})};
    const std::vector<OutlinePoint> points = project_outline(square, camera);
    REQUIRE(points.size() == 4);
    CHECK(points[0].h == test::rounded(0.25));
    CHECK(points[0].v == test::rounded(0.25));
    CHECK(points[2].h == test::rounded(0.75));
    CHECK(points[2].v == test::rounded(0.75));
}

TEST_CASE("projected outline: what is behind the eye is cut off, where an edge crosses") {
    View view;
    view.horizontal = 90, view.vertical = 90;
    const Camera camera(view);
    const std::vector<Vec3> behind{{0.6, -0.8, 0}, {0, -0.8, 0.6}, {-0.6, -0.8, 0}};
    CHECK(project_outline(behind, camera).empty());
    const std::vector<Vec3> across{normalize({0, 1, -1}), normalize({1, -1, -1}),
                                   normalize({1, -1, 1}), normalize({0, 1, 1})};
    const std::vector<OutlinePoint> points = project_outline(across, camera);
    CHECK(points.size() == 4);
    for (const OutlinePoint& p : points) CHECK(p.h >= 0.5 - test::kRounding);
    CHECK(std::count_if(points.begin(), points.end(),
                        [](const OutlinePoint& p) { return p.h > 5; }) == 2);
    View parallel = view;
    parallel.type = 'l';
    CHECK(project_outline(across, Camera(parallel)).empty());
}

TEST_CASE("projected outline: edges are curves in a fisheye") {
    const Camera camera(fisheye_view('a'));
    // Along the horizon of an eye that looks 45 degrees up.
    const std::vector<Vec3> triangle{normalize({-1, 0.1, -0.1}), normalize({0, 1, -1}),
                                     normalize({1, 0.1, -0.1})};
    const std::vector<OutlinePoint> points = project_outline(triangle, camera);
    CHECK(points.size() > 40);
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double step =
            std::hypot(points[i].h - points[i - 1].h, points[i].v - points[i - 1].v) * 180;
        CHECK(step < 5 * kPi / 2 * 1.01);  // 5 degrees, stretched along the rim by pi / 2 at most
    }
}
