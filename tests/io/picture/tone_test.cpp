#include "io/picture/tone.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace lightwalk;

namespace {

using Pixel8 = std::array<std::uint8_t, 3>;

const DisplayTone kLinear{1, std::nullopt};

DisplayTone with_white(double white) {
    return {1, HighlightCurve(white)};
}

int grey_byte(double value, const DisplayTone& tone) {
    return display_pixel(Rgb::grey(static_cast<float>(value)), tone)[0];
}

/// 2000 pixels of middle grey, and `bright` of another radiance.
Picture with_highlights(int bright, float radiance) {
    Picture picture{1, 2000 + bright, std::vector<Rgb>(2000, Rgb::grey(0.18f))};
    picture.pixels.insert(picture.pixels.end(), static_cast<std::size_t>(bright),
                          Rgb::grey(radiance));
    return picture;
}

}  // namespace

TEST_CASE("automatic exposure shows the log-average as middle grey, whatever the picture's unit") {
    for (const float unit : {1e-3f, 1.0f, 1e4f}) {
        Picture picture{2, 2, {Rgb::grey(unit / 10), Rgb::grey(10 * unit), {}, Rgb::grey(unit)}};
        const DisplayTone tone = choose_tone(picture, {});
        CHECK(tone.scale * static_cast<double>(unit) == doctest::Approx(0.18).epsilon(1e-5));
        CHECK(display_pixel(picture.pixels[3], tone) == Pixel8{118, 118, 118});  // sRGB of 18 %
    }
}

TEST_CASE("a picture without light, or with numbers that are none, has an exposure all the same") {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(choose_tone({}, {}).scale == 1);
    CHECK(choose_tone({1, 1, {Rgb{}}}, {}).scale == 1);
    CHECK(choose_tone({1, 1, {Rgb{}}}, {}).curve->white() == 1);
    CHECK(choose_tone({2, 1, {Rgb::grey(inf), Rgb::grey(1)}}, {}).scale == doctest::Approx(0.18));
    CHECK(choose_tone({2, 1, {Rgb::grey(inf), Rgb::grey(1)}}, {}).curve->white() == 1);
    CHECK(display_pixel({inf, nan, -1}, kLinear) == Pixel8{255, 0, 0});
    CHECK(display_pixel({inf, nan, -1}, {}) == Pixel8{255, 255, 255});
    CHECK(display_pixel({nan, nan, -1}, {}) == Pixel8{0, 0, 0});
}

TEST_CASE("a fixed exposure counts in stops, and fixes the curve for all pictures") {
    for (const float radiance : {1.0f, 1000.0f}) {
        const Picture picture{1, 1, {Rgb::grey(radiance)}};
        CHECK(choose_tone(picture, {false, 3}).scale == 8);
        CHECK(choose_tone(picture, {false, -1}).scale == 0.5);
        CHECK(choose_tone(picture, {false, 3}).curve->white() == 16);
    }
}

TEST_CASE("white is where one pixel in a thousand is brighter, and display white at least") {
    CHECK(choose_tone(with_highlights(200, 9), {}).curve->white() > 6);    // a window
    CHECK(choose_tone(with_highlights(1, 1e6f), {}).curve->white() == 1);  // a glint
    CHECK(choose_tone(with_highlights(0, 0), {}).curve->white() == 1);
}

TEST_CASE("the curve is the exposure alone up to a stop above middle grey, and goes on smoothly") {
    for (const double white : {1.0, 2.0, 16.0, 1e4}) {
        const HighlightCurve curve(white);
        for (double x = 0; x <= 0.36; x += 0.01) CHECK(curve(x) == x);
        const double step = 1e-6;
        const double slope = (curve(0.36 + step) - 0.36) / step;
        // It bends by c / (1 - 0.36), c < 14 for these, times half the step.
        CHECK(std::abs(slope - 1) < 11 * step + 1e-9);
    }
}

TEST_CASE(
    "the curve rises everywhere below white, reaches 1 there and not before, and never falls") {
    for (const double white : {1.5, 4.0, 16.0, 300.0}) {
        CAPTURE(white);
        const HighlightCurve curve(white);
        double previous = -1;
        for (double x = 0; x < white; x += white / 5000) {
            const double y = curve(x);
            CHECK(y > previous);
            CHECK(y <= x + 1e-15);  // rounding of logarithm and quotient
            CHECK(y < 1);
            previous = y;
        }
        CHECK(curve(white) == 1);
        CHECK(curve(white * (1 - 1e-9)) == doctest::Approx(1).epsilon(1e-8));
        CHECK(curve(10 * white) == 1);
    }
}

TEST_CASE("with white at the display's own the curve changes nothing") {
    const HighlightCurve curve(1);
    for (double x = 0; x <= 1; x += 0.01) {
        CHECK(curve(x) == doctest::Approx(x).epsilon(1e-8));
        CHECK(grey_byte(x, with_white(1)) == grey_byte(x, kLinear));
    }
}

TEST_CASE("windows are drawn: a stop more is seen at every brightness below white") {
    for (double x = 1; x <= 32; x *= 1.1) {
        CAPTURE(x);
        CHECK(grey_byte(2 * x, with_white(64)) >=
              grey_byte(x, with_white(64)) + 8);  // of 255 for six stops
        CHECK(grey_byte(x, kLinear) == 255);
    }
}

TEST_CASE("linear is sRGB, cut off at white") {
    CHECK_FALSE(choose_tone(with_highlights(200, 9), {.curve = ToneCurve::linear}).curve);
    const DisplayTone& tone = kLinear;
    CHECK(grey_byte(0, tone) == 0);
    CHECK(grey_byte(0.0031308, tone) == 10);
    CHECK(grey_byte(0.5, tone) == 188);
    CHECK(grey_byte(1, tone) == 255);
    CHECK(grey_byte(100, tone) == 255);
    CHECK(display_pixel({0.5f, 0, 2}, tone) == Pixel8{188, 0, 255});
}

TEST_CASE("a colour keeps its order of channels, none falls as light rises, and it ends in white") {
    const DisplayTone tone = with_white(50);
    Pixel8 previous{};
    for (float light = 0.01f; light < 200; light *= 1.05f) {
        CAPTURE(light);
        const Pixel8 bytes = display_pixel(light * Rgb{1, 0.4f, 0.1f}, tone);
        CHECK(bytes[0] >= bytes[1]);
        CHECK(bytes[1] >= bytes[2]);
        for (std::size_t k = 0; k < 3; ++k) CHECK(bytes[k] >= previous[k]);
        previous = bytes;
    }
    // Dim: the proportions are untouched. At four times display white they still show.
    CHECK(display_pixel({0.1f, 0.04f, 0.01f}, tone) ==
          display_pixel({0.1f, 0.04f, 0.01f}, kLinear));
    const Pixel8 lamp = display_pixel({4, 1.6f, 0.4f}, tone);
    CHECK(lamp[0] > lamp[1] + 20);
    CHECK(lamp[1] > lamp[2] + 20);
    CHECK(display_pixel({5000, 2000, 500}, tone)[2] > 250);
}
