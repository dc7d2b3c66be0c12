#include "core/material/fresnel.h"

#include <doctest/doctest.h>

#include "core/math/vec3.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

TEST_CASE(
    "Fresnel estimate: nothing at normal incidence, nearly everything at grazing, falling in "
    "between") {
    CHECK(fresnel_estimate(1) == within(2e-12, 0));  // eleven decimals of the constant
    CHECK(fresnel_estimate(0) == printed(5, 0.99712));
    for (double c = 0.01; c <= 1; c += 0.01)
        CHECK(fresnel_estimate(c) < fresnel_estimate(c - 0.01));
}

TEST_CASE("a boundary conserves energy: R + T / eta² = 1 until total reflection") {
    for (const double eta : {1 / 1.52, 1.0, 1.52, 2.4}) {
        for (double c = 0.005; c <= 1; c += 0.005) {
            const Refraction r = refract(c, eta);
            CAPTURE(eta);
            CAPTURE(c);
            CHECK(r.reflectance >= 0);
            CHECK(r.reflectance + r.transmittance / (eta * eta) == rounded(1));
            if (r.cos_t > 0) {  // Snell
                CHECK(std::sqrt(1 - r.cos_t * r.cos_t) == rounded(eta * std::sqrt(1 - c * c)));
            }
        }
    }
}

TEST_CASE("a boundary reflects the same share from both sides along one path") {
    for (double c = 0.05; c <= 1; c += 0.05) {
        const Refraction in = refract(c, 1 / 1.5);
        const Refraction out = refract(in.cos_t, 1.5);
        CHECK(out.reflectance == rounded(in.reflectance));
        CHECK(in.transmittance * out.transmittance ==
              rounded((1 - in.reflectance) * (1 - in.reflectance)));
    }
}

TEST_CASE("normal incidence, Brewster's angle, the critical angle and grazing") {
    CHECK(refract(1, 1 / 1.5).reflectance == rounded(0.04));
    const double brewster = std::atan(1.5);
    const double cos_t = std::cos(std::asin(std::sin(brewster) / 1.5));
    CHECK(fresnel(std::cos(brewster), cos_t, 1.5).parallel < 1e-20);
    const double critical = std::asin(1 / 1.5);
    CHECK(refract(std::cos(critical + 0.01), 1.5).reflectance == 1);
    CHECK(refract(std::cos(critical + 0.01), 1.5).transmittance == 0);
    CHECK(refract(std::cos(critical - 0.01), 1.5).reflectance < 0.9);
    CHECK(refract(0, 1 / 1.5).reflectance == 1);
}

TEST_CASE("pane at normal incidence, tn 0.96 and index 1.52, by hand") {
    const double inside = cosine_in_pane(1, 1.52);
    const PolarizedReflectance r = fresnel(1, inside, 1.52);
    CHECK(inside == 1);
    CHECK(r.perpendicular == printed(6, 0.0425800));
    CHECK(r.parallel == rounded(r.perpendicular));
    CHECK(pane_transmittance(r.perpendicular, 0.96) == printed(6, 0.881460));
    CHECK(pane_reflectance(r.perpendicular, 0.96) == printed(6, 0.0786112));
}

TEST_CASE(
    "pane: the closed forms are the sums over all internal bounces, and lose nothing but "
    "absorption") {
    for (const double r : {0.01, 0.04, 0.3, 0.95}) {
        for (const double d : {0.1, 0.8, 1.0}) {
            double through = (1 - r) * d * (1 - r);
            double back = r + (1 - r) * d * r * d * (1 - r);
            double t = through, b = back;
            double next_through = through, next_back = back - r;
            for (int i = 0; i < 2000; ++i) {
                next_through *= r * r * d * d;
                next_back *= r * r * d * d;
                t += next_through;
                b += next_back;
            }
            CAPTURE(r);
            CAPTURE(d);
            CHECK(pane_transmittance(r, d) == rounded(t));
            CHECK(pane_reflectance(r, d) == rounded(b));
            if (d == 1)
                CHECK(pane_transmittance(r, d) + pane_reflectance(r, d) == rounded(1));
            else
                CHECK(pane_transmittance(r, d) + pane_reflectance(r, d) < 1);
        }
    }
}

TEST_CASE("pane at grazing incidence reflects everything, absorbing or not") {
    const PolarizedReflectance r = fresnel(0, cosine_in_pane(0, 1.52), 1.52);
    for (const double d : {0.0, 0.5, 1.0}) {
        CHECK(pane_reflectance(r.perpendicular, d) == 1);
        CHECK(pane_transmittance(r.parallel, d) == 0);
    }
}
