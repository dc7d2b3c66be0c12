#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "io/picture/picture.h"

using namespace lightwalk;

namespace {

int grey_byte(double value) {
    return display_pixel(Rgb::grey(static_cast<float>(value)), 1)[0];
}

}  // namespace

TEST_CASE("automatic exposure shows the log-average as middle grey, whatever the picture's unit") {
    for (const float unit : {1e-3f, 1.0f, 1e4f}) {
        Picture picture{2, 2, {Rgb::grey(unit / 10), Rgb::grey(10 * unit), {}, Rgb::grey(unit)}};
        const double scale = display_scale(picture, {});
        CHECK(scale * static_cast<double>(unit) == doctest::Approx(0.18).epsilon(1e-5));
        CHECK(display_pixel(picture.pixels[3], scale) ==
              std::array<std::uint8_t, 3>{118, 118, 118});  // sRGB of 18 %
    }
}

TEST_CASE("a picture without light, or with numbers that are none, has an exposure all the same") {
    const float inf = std::numeric_limits<float>::infinity();
    CHECK(display_scale({}, {}) == 1);
    CHECK(display_scale({1, 1, {Rgb{}}}, {}) == 1);
    CHECK(display_scale({2, 1, {Rgb::grey(inf), Rgb::grey(1)}}, {}) == doctest::Approx(0.18));
    CHECK(display_pixel({inf, std::numeric_limits<float>::quiet_NaN(), -1}, 1) ==
          std::array<std::uint8_t, 3>{255, 0, 0});
}

TEST_CASE("a fixed exposure counts in stops") {
    CHECK(display_scale({1, 1, {Rgb::grey(1)}}, {false, 3}) == 8);
    CHECK(display_scale({1, 1, {Rgb::grey(1)}}, {false, -1}) == 0.5);
}

TEST_CASE(
    "the display curve is sRGB below the knee, rises everywhere, and reaches white smoothly") {
    CHECK(grey_byte(0) == 0);
    CHECK(grey_byte(0.0031308) == 10);
    CHECK(grey_byte(0.5) == 188);
    CHECK(grey_byte(100) == 255);
    int previous = 0;
    for (double x = 0; x < 3; x += 0.001) {
        const int byte = grey_byte(x);
        CHECK(byte >= previous);
        CHECK(byte <= previous + 4);
        previous = byte;
    }
    CHECK(grey_byte(1) < 250);  // highlights keep some room
}
