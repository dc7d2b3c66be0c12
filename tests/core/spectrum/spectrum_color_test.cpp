#include "core/spectrum/spectrum_color.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/spectrum/cie_observer.h"

using namespace lightwalk;

namespace {

Rgb color_of(double first, double last, std::vector<double> values) {
    const WavelengthEnds ends = ends_of_samples(first, last, values.size());
    return SpectrumColor(ends, values.size())(values);
}

void check_color(const Rgb& color, const std::array<double, 3>& expected, double tolerance) {
    for (std::size_t c = 0; c < 3; ++c)
        CHECK(static_cast<double>(color[c]) == doctest::Approx(expected[c]).epsilon(tolerance));
}

}  // namespace

TEST_CASE("observer: what lies below a wavelength rises from 0 to 1") {
    std::array<double, 3> before{};
    for (double nm = 300; nm <= 900; nm += 0.5) {
        const std::array<double, 3> below = observer_below(nm);
        for (std::size_t c = 0; c < 3; ++c) CHECK(below[c] >= before[c]);
        before = below;
    }
    for (std::size_t c = 0; c < 3; ++c) {
        CHECK(observer_below(358)[c] == 0);
        CHECK(before[c] == doctest::Approx(1).epsilon(1e-12));
    }
    // Half of luminance lies below the peak's neighbourhood, as photometric tables have it.
    CHECK(observer_below(558.5)[1] == doctest::Approx(0.5).epsilon(0.02));
}

TEST_CASE("spectrum: equal energy is white, to the rounding of bands") {
    check_color(color_of(380, 780, {1, 1, 1, 1, 1}), {1, 1, 1}, 1e-3);
    check_color(color_of(780, 380, {1, 1, 1, 1, 1}), {1, 1, 1}, 1e-6);
    check_color(color_of(360, 830, std::vector<double>(40, 2.5)), {2.5, 2.5, 2.5}, 1e-3);
}

TEST_CASE("spectrum: the same from either end, where its bands are taken as they are") {
    const std::vector<double> rising{0.05, 0.1, 0.15, 0.3, 0.5, 0.7, 0.8, 0.85, 0.9};
    std::vector<double> falling(rising.rbegin(), rising.rend());
    const Rgb a = color_of(400, 720, rising), b = color_of(720, 400, falling);
    check_color(a, {0.813565, 0.4034397, 0.06015138}, 2e-3);
    check_color(b, {0.813565, 0.4034397, 0.06015138}, 2e-3);
}

TEST_CASE("spectrum: three falling values are red, green and blue, three rising ones a spectrum") {
    check_color(color_of(650, 450, {0.8, 0.5, 0.2}), {0.8, 0.5, 0.2}, 1e-6);
    check_color(color_of(450, 650, {0.2, 0.5, 0.8}), {0.7503211, 0.4681091, 0.1391189}, 2e-3);
}

TEST_CASE(
    "spectrum: colours that the primaries cannot show keep their luminance, none is negative") {
    for (const double nm : {430.0, 480.0, 500.0, 520.0, 600.0, 650.0}) {
        const std::vector<double> values{1, 1, 1, 1, 1, 1};
        const Rgb color = color_of(nm + 15, nm - 15, values);
        CAPTURE(nm);
        CHECK(min_component(color) >= 0);
        const double y = observer_below(nm + 18)[1] - observer_below(nm - 18)[1];
        CHECK(static_cast<double>(brightness(color)) == doctest::Approx(y).epsilon(1e-4));
    }
}

TEST_CASE("spectrum: colour is linear in the values where it is not clipped") {
    const SpectrumColor color(ends_of_samples(400, 700, 7), 7);
    const std::vector<double> a{.2, .3, .4, .5, .6, .5, .4}, b{.5, .5, .4, .4, .3, .3, .3};
    std::vector<double> sum(7);
    for (std::size_t i = 0; i < 7; ++i) sum[i] = 2 * a[i] + b[i];
    const Rgb both = color(a) * 2.0f + color(b), at_once = color(sum);
    for (std::size_t c = 0; c < 3; ++c) CHECK(at_once[c] == doctest::Approx(both[c]).epsilon(1e-5));
}
