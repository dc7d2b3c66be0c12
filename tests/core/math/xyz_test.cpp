#include "core/math/xyz.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace lightwalk;

TEST_CASE(
    "XYZ: Y is the photopic luminance, white has X = Y = Z, and the way back is the inverse") {
    const Rgb white = to_xyz({1, 1, 1});
    for (std::size_t i = 0; i < 3; ++i) CHECK(white[i] == doctest::Approx(179).epsilon(1e-6));
    for (const Rgb& color : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{3, .2f, 40}}) {
        const Rgb xyz = to_xyz(color);
        CHECK(xyz.g == doctest::Approx(static_cast<double>(179 * brightness(color))));
        const Rgb back = from_xyz(xyz);
        // The two matrices have nine and ten digits, their product is as far from 1 as a float is.
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(std::abs(back[i] - color[i]) < 1e-5f * max_component(color));
    }
}
