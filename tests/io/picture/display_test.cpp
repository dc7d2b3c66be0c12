#include "io/picture/display.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "io/picture/human_tone.h"
#include "io/picture/picture.h"
#include "io/picture/tone.h"

using namespace lightwalk;

namespace {

/// Greys and colours over twelve decades.
std::vector<Rgb> many_colours() {
    std::vector<Rgb> pixels;
    for (int i = 0; i < 4000; ++i) {
        const auto L = static_cast<float>(std::pow(10.0, -6 + i * 12.0 / 4000));
        pixels.push_back({L, L * static_cast<float>(i % 7) / 7, L * static_cast<float>(i % 5) / 5});
    }
    return pixels;
}

std::vector<std::uint8_t> shown(const std::vector<Rgb>& pixels, const DisplaySettings& settings) {
    const BrightnessHistogram histogram(pixels);
    Adaptation eye;
    eye.look_at(histogram, 0);
    std::vector<std::uint8_t> bytes(3 * pixels.size());
    Display(settings, eye, histogram).show(pixels, bytes);
    return bytes;
}

}  // namespace

TEST_CASE("a display with a fixed exposure shows what pictures for the screen show") {
    const std::vector<Rgb> pixels = many_colours();
    for (const double ev : {-3.0, 0.0, 4.0}) {
        DisplaySettings settings;
        settings.automatic = false;
        settings.ev = ev;
        const std::vector<std::uint8_t> bytes = shown(pixels, settings);
        const DisplayTone tone = choose_tone({}, {false, ev, ToneCurve::highlights});
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const std::array<std::uint8_t, 3> expected = display_pixel(pixels[i], tone);
            for (std::size_t k = 0; k < 3; ++k)
                REQUIRE(std::abs(bytes[3 * i + k] - expected[k]) <= 1);
        }
    }
}

TEST_CASE("automatic exposure is that of pictures for the screen") {
    const Picture picture{40, 100, many_colours()};
    Adaptation eye;
    eye.look_at(BrightnessHistogram(picture.pixels), 0);
    const Display display({}, eye, BrightnessHistogram(picture.pixels));
    CHECK(display.exposure() == doctest::Approx(choose_tone(picture, {}).scale).epsilon(1e-6));
}

TEST_CASE("eyes get used to another light: half of the way at once would be a flash") {
    const std::vector<Rgb> dark(100, Rgb::grey(0.01f)), bright(100, Rgb::grey(100));
    Adaptation eye;
    eye.look_at(BrightnessHistogram(dark), 0.03);
    CHECK(eye.average() == doctest::Approx(0.01));
    double before = eye.average();
    for (int i = 0; i < 100; ++i) {
        eye.look_at(BrightnessHistogram(bright), 0.03);
        CHECK(eye.average() > before);
        CHECK(eye.average() < 2 * before);
        before = eye.average();
    }
    CHECK(eye.average() == doctest::Approx(100).epsilon(0.01));
    Adaptation other;  // that has seen nothing yet: what it looks at first it sees at once
    other.look_at(BrightnessHistogram(dark), 0);
    CHECK(other.average() == doctest::Approx(0.01));
}

TEST_CASE("what is not a number, or less than nothing, is black on any display") {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    const std::vector<Rgb> odd{{nan, nan, nan}, {-1, -1, -1}, {0, 0, 0}, {infinite, infinite, 1}};
    for (const bool human : {false, true}) {
        DisplaySettings settings;
        settings.automatic = false;
        settings.human = human;
        const std::vector<std::uint8_t> bytes = shown(odd, settings);
        for (std::size_t i = 0; i < 9; ++i) CHECK(bytes[i] == 0);
        CHECK(bytes[9] > 200);
    }
}

TEST_CASE("false colours: the ends of the scale, its middle, and what is beyond") {
    DisplaySettings settings;
    settings.false_colour = true;
    settings.low = 10;
    settings.high = 1000;
    const auto of = [&](double luminance) {
        return shown({Rgb::grey(static_cast<float>(luminance / 179))}, settings);
    };
    const auto colour = [](double at) {
        std::vector<std::uint8_t> bytes;
        for (const double channel : scale_colour(at))
            bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * channel)));
        return bytes;
    };
    const auto near = [](const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
        for (std::size_t k = 0; k < 3; ++k)
            if (std::abs(a[k] - b[k]) > 2) return false;
        return true;
    };
    CHECK(near(of(10), colour(0)));
    CHECK(near(of(100), colour(0.5)));
    CHECK(near(of(1000), colour(1)));
    CHECK(of(1) == colour(0));
    CHECK(of(1e5) == colour(1));
    settings.logarithmic = false;
    CHECK(near(of(505), colour(0.5)));
    CHECK(of(0) == colour(0));
}

TEST_CASE("human vision: brighter never looks darker, and the screen's range is used") {
    const BrightnessHistogram histogram(many_colours());
    const HumanTone tone(histogram);
    double before = 0;
    for (double L = 1e-4; L < 1e9; L *= 1.1) {
        CHECK(tone(L) >= before);
        before = tone(L);
    }
    CHECK(tone(1e-4) < 0.05);
    CHECK(before > 0.95);
}

TEST_CASE("human vision: a scene that a screen can show is shown with its own contrasts") {
    std::vector<Rgb> pixels;
    for (int i = 0; i < 1000; ++i)
        pixels.push_back(Rgb::grey(static_cast<float>((50 + 0.1 * i) / 179)));
    const HumanTone tone{BrightnessHistogram(pixels)};
    CHECK(tone(100) / tone(50) == doctest::Approx(2).epsilon(0.05));
}

TEST_CASE("visible differences: continuous, and a share of the luminance in the light") {
    // Ferwerda's pieces meet, roughly, at their ends; in between they rise.
    double before = visible_difference(1e-5);
    for (double L = 1e-5; L < 1e5; L *= 1.05) {
        const double now = visible_difference(L);
        CHECK(now >= before * 0.99);
        CHECK(now <= before * 1.2);
        before = now;
    }
    CHECK(visible_difference(1000) / 1000 == doctest::Approx(0.0556).epsilon(0.01));
    CHECK(colour_sensitivity(1e-3) == 0);
    CHECK(colour_sensitivity(10) == 1);
}
