#include "core/view/view.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

View view_of(char type, double horizontal, double vertical) {
    View view;
    view.type = type;
    view.position = {1, 2, 3};
    view.horizontal = horizontal;
    view.vertical = vertical;
    return view;
}

void check_near(const Vec3& a, const Vec3& b, double tolerance) {
    CAPTURE(a.x);
    CAPTURE(a.y);
    CAPTURE(a.z);
    CHECK(length(a - b) < tolerance);
}

/// One view of every type, tilted, shifted and clipped.
std::array<View, 6> tilted_views() {
    std::array<View, 6> views{view_of('v', 60, 40),   view_of('l', 4, 2),
                              view_of('h', 170, 150), view_of('c', 300, 100),
                              view_of('a', 250, 220), view_of('s', 300, 200)};
    for (View& view : views) {
        view.direction = {0.3, -1.2, 0.4};
        view.up = {0.2, 0.1, 2};
        view.fore = 0.5;
        view.aft = 12;
        view.shift = 0.1;
        view.lift = -0.05;
    }
    return views;
}

}  // namespace

TEST_CASE("view rays equal Radiance's, with fore and aft clipping") {
    struct Row {
        char type;
        double horizontal, vertical;
        Vec3 origin, direction;
        double limit;
    };
    const std::array<Row, 6> rows{{
        {'v',
         60,
         40,
         {1.144337567, 2.5, 3.036397023},
         {0.276674267, 0.958427775, 0.069767836},
         9.912066670},
        {'l', 4, 2, {2, 2.5, 3.2}, {0, 1, 0}, 9.5},
        {'h', 180, 180, {1.25, 2.421307489, 3.1}, {0.5, 0.842614977, 0.2}, 9.5},
        {'c',
         180,
         90,
         {1.353553391, 2.353553391, 3.1},
         {0.693375245, 0.693375245, 0.196116135},
         9.688137076},
        {'a',
         180,
         180,
         {1.347513958, 2.331529028, 3.139005583},
         {0.695027916, 0.663058057, 0.278011167},
         9.5},
        {'s',
         180,
         180,
         {1.387596899, 2.275193798, 3.155038760},
         {0.775193798, 0.550387597, 0.310077519},
         9.5},
    }};
    for (const Row& row : rows) {
        CAPTURE(row.type);
        View view = view_of(row.type, row.horizontal, row.vertical);
        view.fore = 0.5;
        view.aft = 10;
        const auto ray = Camera(view).ray(0.75, 0.6);
        REQUIRE(ray);
        constexpr double kDigits = 1e-9;  // nine are given: half a unit of the last, and ours
        check_near(ray->origin, row.origin, kDigits);
        check_near(ray->direction, row.direction, kDigits);
        CHECK(std::abs(ray->limit - row.limit) < kDigits);
    }
}

TEST_CASE("a view's axes are right-handed: looking along +y with z up, right is +x") {
    const Camera camera{View{}};
    check_near(camera.right(), {1, 0, 0}, kFewRoundings);
    check_near(camera.upward(), {0, 0, 1}, kFewRoundings);
    for (const View& view : tilted_views()) {
        const Camera tilted(view);
        check_near(cross(tilted.right(), tilted.forward()), tilted.upward(), kFewRoundings);
        CHECK(std::abs(dot(tilted.right(), view.up)) < kRounding);
        CHECK(std::abs(length(tilted.upward()) - 1) < kFewRoundings);
    }
}

TEST_CASE("locate is the inverse of ray, for all view types") {
    for (const View& view : tilted_views()) {
        CAPTURE(view.type);
        const Camera camera(view);
        int rays = 0;
        for (int i = 0; i < 15; ++i) {
            for (int j = 0; j < 15; ++j) {
                const double h = (i + 0.5) / 15, v = (j + 0.5) / 15;
                const auto ray = camera.ray(h, v);
                if (!ray) continue;
                // Points of a cylinder's or a sphere's far side have other positions too: stay
                // within the type.
                const double x = (h - 0.5 + view.shift) * view.horizontal;
                if (view.type == 'c' && std::abs(x) >= 180) continue;
                ++rays;
                CHECK(std::abs(length(ray->direction) - 1) < 10 * kFewRoundings);
                for (const double t : {1e-3, 0.7, 5.0}) {
                    const auto at = camera.locate(ray->origin + t * ray->direction);
                    CHECK(std::abs(at.h - h) < kRounding);
                    CHECK(std::abs(at.v - v) < kRounding);
                    CHECK(std::abs(at.distance - t) < kRounding);
                    CHECK(at.visible());
                }
            }
        }
        CHECK(rays > 100);
    }
}

TEST_CASE("the aft surface clips at the ray's limit, the fore surface at its origin") {
    for (const View& view : tilted_views()) {
        CAPTURE(view.type);
        const Camera camera(view);
        const auto ray = camera.ray(0.45, 0.6);
        REQUIRE(ray);
        const auto at = [&](double t) { return camera.locate(ray->origin + t * ray->direction); };
        CHECK(at(ray->limit - 1e-6).visible());
        CHECK(at(ray->limit + 1e-6).beyond_aft);
        CHECK_FALSE(at(-1e-6).in_front);
    }
}

TEST_CASE("a point behind a perspective view is not in front, the view point has no image") {
    const Camera camera(view_of('v', 60, 40));
    CHECK_FALSE(camera.locate({1, 1, 3}).in_front);
    CHECK(camera.locate({1, 3, 3}).in_front);
    for (const char type : {'v', 'h', 'c', 'a', 's'}) {
        CAPTURE(type);
        const auto at = Camera(view_of(type, 90, 90)).locate({1, 2, 3});
        CHECK_FALSE(at.in_front);
        CHECK(at.h == -1);
    }
    CHECK_FALSE(Camera(view_of('s', 180, 180)).locate({1, 0, 3}).in_front);  // the pole
    const auto behind = Camera(view_of('a', 360, 360)).locate({1, 0, 3});
    CHECK(behind.h == rounded(1));
    CHECK(behind.v == rounded(0.5));
}

TEST_CASE("beyond their domain, fisheye views have no ray") {
    CHECK_FALSE(Camera(view_of('h', 180, 180)).ray(0.01, 0.01));
    CHECK(Camera(view_of('h', 180, 180)).ray(0.01, 0.5));
    CHECK_FALSE(Camera(view_of('a', 360, 360)).ray(0.01, 0.01));
    CHECK(Camera(view_of('s', 300, 300)).ray(0.01, 0.01));
}

TEST_CASE("bad views are refused with Radiance's words, in its order") {
    const auto problem = [](auto change) {
        View view;
        change(view);
        return Camera::problem(view).value_or("fine");
    };
    CHECK(problem([](View&) {}) == "fine");
    CHECK(problem([](View& v) { v.fore = -1, v.direction = {}; }) ==
          "illegal fore/aft clipping plane");
    CHECK(problem([](View& v) { v.fore = 2, v.aft = 2; }) == "illegal fore/aft clipping plane");
    CHECK(problem([](View& v) { v.aft = -1; }) == "illegal fore/aft clipping plane");
    CHECK(problem([](View& v) { v.direction = {}, v.up = {}; }) == "zero view direction");
    CHECK(problem([](View& v) { v.up = {}; }) == "zero view up vector");
    CHECK(problem([](View& v) { v.up = {0, -3, 0}; }) == "view up parallel to view direction");
    CHECK(problem([](View& v) { v.horizontal = 0; }) == "illegal horizontal view size");
    CHECK(problem([](View& v) { v.horizontal = 180; }) == "illegal horizontal view size");
    CHECK(problem([](View& v) { v.vertical = 180; }) == "illegal vertical view size");
    CHECK(problem([](View& v) { v.type = 'x'; }) == "unknown view type 'x'");
    CHECK(problem([](View& v) { v.type = 'h', v.horizontal = 181; }) ==
          "illegal horizontal view size");
    CHECK(problem([](View& v) { v.type = 'h', v.horizontal = v.vertical = 180; }) == "fine");
    CHECK(problem([](View& v) { v.type = 'c', v.horizontal = 360; }) == "fine");
    CHECK(problem([](View& v) { v.type = 'c', v.vertical = 180; }) == "illegal vertical view size");
    CHECK(problem([](View& v) { v.type = 'a', v.horizontal = v.vertical = 360; }) == "fine");
    CHECK(problem([](View& v) { v.type = 's', v.horizontal = 360; }) ==
          "illegal horizontal view size");
    CHECK(problem([](View& v) { v.type = 'l', v.horizontal = 5000; }) == "fine");
    CHECK(problem([](View& v) { v.lift = std::numeric_limits<double>::quiet_NaN(); }) != "fine");
    View blind;
    blind.direction = {};
    CHECK_THROWS_WITH_AS(Camera{blind}, "zero view direction", InputError);
}

TEST_CASE("the direction's length does not matter, however large or small") {
    View view;
    for (const double scale : {1e-200, 1.0, 1e200}) {
        view.direction = Vec3{0, 1, 0} * scale;
        view.up = Vec3{0, 0.3, 1} * scale;
        check_near(Camera(view).upward(), {0, 0, 1}, kFewRoundings);
    }
}

TEST_CASE("picture sizes follow the view's aspect within the given size") {
    const auto fit = [](int x, int y, double h, double v, double pixel) {
        return fit_picture(x, y, Camera(view_of('v', h, v)).aspect(), pixel);
    };
    const PictureSize panorama = fit(64, 64, 90, 30, 1);
    CHECK(panorama.width == 64);
    CHECK(panorama.height == 17);
    CHECK(fit(320, 240, 45, 60, 1).width == 172);  // as in a picture by Radiance
    CHECK(fit(320, 240, 60, 45, 1).height == 230);
    const PictureSize stretched = fit(64, 32, 60, 60, 0);
    CHECK(stretched.width == 64);
    CHECK(stretched.height == 32);
    CHECK(stretched.pixel_aspect == rounded(2));
    const PictureSize tall = fit(100, 100, 60, 60, 2);
    CHECK(tall.width == 100);
    CHECK(tall.height == 50);
    CHECK(fit_picture(0, 100, 1, 1).width == 0);
    CHECK(fit_picture(-5, 100, 1, 1).width == 0);
}

TEST_CASE("a cropped view shows the same rays as its part of the whole") {
    for (const View& view : tilted_views()) {
        CAPTURE(view.type);
        const auto part = crop_view(view, 0.25, 0.4, 0.5, 0.9);
        REQUIRE(part);
        const auto a = Camera(*part).ray(0.3, 0.6),
                   b = Camera(view).ray(0.25 + 0.3 * 0.25, 0.4 + 0.6 * 0.5);
        REQUIRE(a);
        REQUIRE(b);
        check_near(a->origin, b->origin, kRounding);
        check_near(a->direction, b->direction, kRounding);
    }
    CHECK_FALSE(crop_view(View{}, 0.5, 0, 0.5, 1));
    CHECK_FALSE(crop_view(view_of('h', 120, 120), -1, 0, 2, 1));
}
