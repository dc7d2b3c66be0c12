#include "core/glare/dgp.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/tolerance.h"

using namespace lightwalk;
using test::printed;
using test::rounded;

namespace {

/// Of a direction `sigma` degrees from the line of sight, in the plane `tau` degrees from upright.
double index_at(double tau, double sigma) {
    const double t = tau * kPi / 180, s = sigma * kPi / 180;
    return position_index({std::sin(s) * std::sin(t), std::cos(s), std::sin(s) * std::cos(t)},
                          Camera(View{}));
}

}  // namespace

TEST_CASE("position index: 1 on the line of sight, rising away from it in every direction") {
    CHECK(index_at(0, 0) == rounded(1));
    for (double tau = 0; tau < 360; tau += 15) {
        double last = 1;
        for (double sigma = 2; sigma <= 88; sigma += 2) {
            CAPTURE(tau);
            CAPTURE(sigma);
            const double index = index_at(tau, sigma);
            CHECK(index >= last);
            if (last < 16) CHECK(index > last);
            CHECK(index <= 16);
            last = index;
        }
    }
}

TEST_CASE("position index: Guth's closed form above the line of sight") {
    // Straight up: ln P = (35.2 - 1.22) 1e-3 sigma + 21e-5 sigma².
    CHECK(index_at(0, 20) == rounded(std::exp(33.98e-3 * 20 + 21e-5 * 400)));
    // In a plane at 45 degrees: 35.2 - 14.35005 - 1.22 e^-10 and 21 + 12.00015 - 6.000075.
    CHECK(index_at(45, 30) ==
          rounded(std::exp((20.84995 - 1.22 * std::exp(-10)) * 1e-3 * 30 + 27.000075e-5 * 900)));
    CHECK(index_at(0, 80) == rounded(16));
}

TEST_CASE("position index: the same left and right, without a step at the height of the eye") {
    for (const double sigma : {5., 40., 85.}) {
        for (const double tau : {20., 70., 110., 160.})
            CHECK(index_at(tau, sigma) == rounded(index_at(360 - tau, sigma)));
        CHECK(index_at(90.0001, sigma) / index_at(89.9999, sigma) == test::within(1e-4, 1));
        // Below it a source disturbs more than as far above.
        CHECK(index_at(180, sigma) < index_at(0, sigma));
    }
}

TEST_CASE("position index: figures of evalglare 3.06 for small sources below the line of sight") {
    // Its column Posindx, for the direction in its columns xdir ydir zdir, which are those of a
    // pixel near the source's middle. It differs from ours by a constant share of 3e-4.
    constexpr double kOffset = 1e-3;
    CHECK(index_at(180, 45.0901) == test::within(kOffset, 2.280488));
    CHECK(index_at(180, 75.1501) == test::within(kOffset, 5.728597));
    CHECK(index_at(180, 10.0) == test::within(kOffset, 1.10733));
}

TEST_CASE("DGP: the formula of 2006, rising with illuminance and glare, at most 1") {
    CHECK(daylight_glare_probability(0, 0) == rounded(0.16));
    CHECK(daylight_glare_probability(1000, 0) == rounded(0.2187));
    // A contrast of 9: the logarithm is 1.
    CHECK(daylight_glare_probability(1000, 9 * std::pow(1000, 1.87)) == rounded(0.3105));
    CHECK(daylight_glare_probability(1e6, 0) == 1);
    CHECK(daylight_glare_probability(0, 1e6) == rounded(0.16));
    for (const double ev : {50., 500., 5000.}) {
        CHECK(daylight_glare_probability(ev * 2, 0) > daylight_glare_probability(ev, 0));
        CHECK(daylight_glare_probability(ev, 2e6) > daylight_glare_probability(ev, 1e6));
    }
}

TEST_CASE("DGP: corrected in low light, as good as not from 500 lx") {
    CHECK(low_light_correction(0) == printed(4, 0.01799));
    CHECK(low_light_correction(4 / 0.024) == rounded(0.5));
    CHECK(low_light_correction(500) == printed(4, 0.9997));
    CHECK(low_light_correction(1e9) == rounded(1));
}

TEST_CASE("DGP: classes and the range of the assessments") {
    CHECK(glare_class(0.35) == GlareClass::imperceptible);
    CHECK(glare_class(0.36) == GlareClass::perceptible);
    CHECK(glare_class(0.41) == GlareClass::disturbing);
    CHECK(glare_class(0.46) == GlareClass::intolerable);
    CHECK(within_assessments(0.3, 1000));
    CHECK_FALSE(within_assessments(0.19, 1000));
    CHECK_FALSE(within_assessments(0.3, 379));
    CHECK_FALSE(within_assessments(0.81, 9000));
}

TEST_CASE("dgp: its slopes are those of the formula, and none where it is at its most") {
    for (const double ev : {50., 900., 5000.})
        for (const double sum : {0., 1e4, 3e7}) {
            CAPTURE(ev);
            CAPTURE(sum);
            const double e = 1e-4 * ev, s = 1e-4 * std::max(sum, 1.0);
            const DgpSlopes slopes = dgp_slopes(ev, sum);
            CHECK(slopes.ev == doctest::Approx((daylight_glare_probability(ev + e, sum) -
                                                daylight_glare_probability(ev - e, sum)) /
                                               (2 * e))
                                   .epsilon(1e-5));
            CHECK(slopes.sum == doctest::Approx((daylight_glare_probability(ev, sum + s) -
                                                 daylight_glare_probability(ev, sum)) /
                                                s)
                                    .epsilon(1e-3));
        }
    CHECK(dgp_slopes(30000, 0).ev == 0);
    CHECK(dgp_slopes(0, 0).sum == 0);
}
