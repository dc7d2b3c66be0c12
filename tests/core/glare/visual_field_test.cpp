#include "core/glare/visual_field.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "tests/core/glare/fisheye_picture.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using test::fisheye_view;
using test::rounded;
using test::within;

namespace {

VisualField even_field(const View& view, int width, int height) {
    const std::vector<Rgb> picture(
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Rgb::grey(1));
    return visual_field({width, height, picture}, Camera(view));
}

double sum_of_solid_angles(const VisualField& field) {
    double sum = 0;
    for (const FieldPixel& pixel : field.pixels) sum += pixel.solid_angle;
    return sum;
}

}  // namespace

TEST_CASE("visual field: the pixels of a fisheye cover the half sphere") {
    for (const char type : {'a', 'h'}) {
        CAPTURE(type);
        // Pixels whose centre is outside are not counted: a part of those on the rim, along 2 π r
        // of them, of which an angular view squeezes less into a pixel than a hemispherical one.
        const double rim = type == 'a' ? 0.5 * (kPi / 200) : std::sqrt(2. / 100);
        const double sum = sum_of_solid_angles(even_field(fisheye_view(type), 200, 200));
        CHECK(sum <= 2 * kPi * (1 + test::kRounding));
        CHECK(sum > 2 * kPi * (1 - rim));
        CHECK(sum_of_solid_angles(even_field(fisheye_view(type), 1, 1)) == rounded(2 * kPi));
        CHECK(sum_of_solid_angles(even_field(fisheye_view(type), 2, 2)) == rounded(2 * kPi));
    }
}

TEST_CASE("visual field: solid angles are the areas of the projections") {
    const int size = 100;
    const double pixel = 2. / size;  // in units of the picture's radius
    for (const FieldPixel& p : even_field(fisheye_view('a'), size, size).pixels) {
        const double angle = std::acos(p.direction.y);
        if (angle > 1.5) continue;
        // sin(angle) / angle per squared angle; its curvature within a pixel is below the square of
        // the pixel's size.
        CHECK(p.solid_angle ==
              within(pixel * pixel, std::sin(angle) / angle * std::pow(pixel * kPi / 2, 2)));
    }
    for (const FieldPixel& p : even_field(fisheye_view('h'), size, size).pixels) {
        if (p.direction.y < 0.5) continue;
        // 1 / cos; flat triangles and a pixel's curvature, which grows as 1 / cos^4.
        CHECK(p.solid_angle ==
              within(pixel * pixel / std::pow(p.direction.y, 4), pixel * pixel / p.direction.y));
    }
}

TEST_CASE("visual field: the illuminance of an even half sphere is pi L") {
    for (const char type : {'a', 'h'}) {
        double ev = 0;
        for (const FieldPixel& p : even_field(fisheye_view(type), 300, 300).pixels)
            ev += p.luminance * p.solid_angle * p.direction.y;
        // Midpoints: second order in the pixel's size, and the rim, where the cosine is small.
        CHECK(ev == within(2e-3, kPi * 179));
    }
}

TEST_CASE("visual field: a perspective's pixels cover its solid angle") {
    View view;
    view.horizontal = 60, view.vertical = 40;
    // Of a rectangle seen from above its middle: 4 asin(sin(a / 2) sin(b / 2)).
    CHECK(sum_of_solid_angles(even_field(view, 30, 17)) ==
          rounded(4 * std::asin(std::sin(kPi / 6) * std::sin(kPi / 9))));
}

TEST_CASE("visual field: rows run from the top, luminance is 179 lm/W of weighted radiance") {
    const std::vector<Rgb> picture{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    const VisualField field = visual_field({2, 2, picture}, Camera(fisheye_view('a')));
    REQUIRE(field.pixels.size() == 4);
    CHECK(field.pixels[0].place == PixelPlace{0, 0});
    CHECK(field.pixels[0].direction.z < 0);
    CHECK(field.pixels[0].direction.x < 0);
    CHECK(field.pixels[0].luminance == test::float_rounded(179 * 0.06478836));
    CHECK(field.pixels[1].luminance == test::float_rounded(179));
    CHECK(field.pixels[2].luminance == test::float_rounded(179 * 0.26510582));
    CHECK(field.pixels[3].luminance == test::float_rounded(179 * 0.67010582));
}

TEST_CASE("visual field: pixels without a luminance are dropped and counted") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    const std::vector<Rgb> picture{Rgb::grey(nan), Rgb::grey(1), Rgb::grey(infinite),
                                   Rgb::grey(-1)};
    const VisualField field = visual_field({2, 2, picture}, Camera(fisheye_view('a')));
    CHECK(field.pixels.size() == 1);
    CHECK(field.dropped == 3);
}

TEST_CASE("visual field: other views and sizes that do not fit are refused") {
    const std::vector<Rgb> picture(4);
    View narrow = fisheye_view('a'), shifted = fisheye_view('h'), wound = fisheye_view('c');
    narrow.horizontal = 120;
    shifted.shift = 0.1;
    wound.vertical = 90;
    for (const View& view : {narrow, shifted, wound})
        CHECK_THROWS_AS((void)visual_field({2, 2, picture}, Camera(view)), InputError);
    const Camera camera(fisheye_view('a'));
    CHECK_THROWS_WITH_AS((void)visual_field({2, 3, picture}, camera),
                         "glare: 4 values for a picture of 2 x 3 pixels", InputError);
    CHECK_THROWS_AS((void)visual_field({0, 0, {}}, camera), InputError);
    CHECK_THROWS_AS((void)visual_field({-2, -2, picture}, camera), InputError);
}
