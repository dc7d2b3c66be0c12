#include "io/picture/difference_colour.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace lightwalk;

TEST_CASE("difference: less and more are mirrored about none, and the scale rises") {
    CHECK(difference_place(3, 3) == 0);
    double last = -2;
    for (const float ratio :
         {.01f, .1f, .25f, .5f, .8f, .99f, 1.f, 1.01f, 1.25f, 2.f, 4.f, 100.f}) {
        const double place = difference_place(2, 2 * ratio);
        CHECK(place >= last);
        CHECK(difference_place(2 * ratio, 2) == doctest::Approx(-place));
        last = place;
    }
    CHECK(difference_place(1, 16) == doctest::Approx(1));
    CHECK(difference_place(1, 2) == doctest::Approx(std::log1p(10) / std::log1p(40)));
}

TEST_CASE("difference: black, infinite and undefined values have their place") {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const float none = std::nanf("");
    CHECK(difference_place(0, 0) == 0);
    CHECK(difference_place(0, 1) == 1);
    CHECK(difference_place(1, 0) == -1);
    CHECK(difference_place(none, 1) == 0);
    CHECK(difference_place(1, none) == 0);
    for (const float a : {0.f, 1.f, kInfinity, none, -1.f})
        for (const float b : {0.f, 1.f, kInfinity, none, -1.f}) (void)difference_colour(a, b);
    CHECK(difference_colour(0, 1) == difference_colour_at(1));
    CHECK(difference_colour(1, kInfinity) == difference_colour_at(1));
    CHECK(difference_colour(kInfinity, kInfinity) == difference_colour_at(0));
}

TEST_CASE("difference: colours are those of the places, to the table's step, grey for none") {
    const auto same = difference_colour(.3f, .3f);
    CHECK(std::abs(same[0] - same[2]) <= 2);
    CHECK(same == difference_colour_at(0));
    for (float ratio = .04f; ratio < 25; ratio *= 1.01f) {
        const auto colour = difference_colour(7, 7 * ratio);
        const auto exact = difference_colour_at(difference_place(7, 7 * ratio));
        for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(colour[k] - exact[k]) <= 4);
    }
    CHECK(difference_colour(1, .25f)[2] > difference_colour(1, .25f)[0]);  // blue: less
    CHECK(difference_colour(1, 4)[0] > difference_colour(1, 4)[2]);        // orange: more
}
