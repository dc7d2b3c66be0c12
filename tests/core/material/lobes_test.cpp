#include "core/material/lobes.h"

#include <doctest/doctest.h>

#include "core/material/orientation.h"
#include "tests/core/chi_square.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

Vec3 lobe_direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Integral of a function of wi over the half sphere about +z, or -z for a side of -1.
template <class F>
double half_sphere_integral(const F& f, double side = 1) {
    return sphere_integral(DirectionCells{{0, 0, 1}, 1, 40, 48},
                           [&](const Vec3& wi) { return side * wi.z > 0 ? f(wi) : 0; });
}
/// What the harness's integrals may be off by.
constexpr double kQuadrature = 1e-5;

const LobeFrame kFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

WardReflection ward(const Vec3& wo, double alpha_u, double alpha_v) {
    return {wo, kFrame, alpha_u, alpha_v};
}
WardTransmission ward_through(const Vec3& wo, double alpha_u, double alpha_v) {
    return {-wo, wo.z, kFrame, alpha_u, alpha_v};
}
AshikhminReflection ashikhmin(const Vec3& wo, double nu, double nv) {
    return {wo, wo.z, kFrame, nu, nv};
}

}  // namespace

TEST_CASE("Ward's lobe peaks at 1 / (4 pi alpha² cos²) in the mirror direction") {
    for (const double theta : {0.0, 0.6, 1.2}) {
        const Vec3 wo = lobe_direction(theta, 0), wi = lobe_direction(theta, kPi);
        const double c = std::cos(theta);
        CHECK(ward_reflection(wo + wi, kFrame.n, 0.02) * 4 * kPi * 0.02 * c * c == rounded(1));
        CHECK(ward(wo, 0.1, 0.2).eval(wi) * 4 * kPi * 0.02 * c * c == rounded(1));
    }
}

TEST_CASE("Ward's lobe of equal slopes is the isotropic one, and turns with its frame") {
    const Vec3 wo = lobe_direction(0.7, 1.9), wi = lobe_direction(0.3, 1.1);
    const double alpha = std::sqrt(0.4), narrow = std::sqrt(0.5), wide = std::sqrt(2);
    CHECK(ward(wo, alpha, alpha).eval(wi) == rounded(ward_reflection(wo + wi, kFrame.n, 0.4)));
    CHECK(ward(wo, alpha, alpha).eval(wi, 0.3) == rounded(ward_reflection(wo + wi, kFrame.n, 0.7)));
    const LobeFrame turned{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    const Vec3 wo_turned{-wo.y, wo.x, wo.z}, wi_turned{-wi.y, wi.x, wi.z};
    const double expected = ward(wo, narrow, wide).eval(wi);
    CHECK(WardReflection{wo_turned, turned, narrow, wide}.eval(wi_turned) == rounded(expected));
    CHECK(std::abs(WardReflection{wo, turned, narrow, wide}.eval(wi) - expected) > 0.01);
}

TEST_CASE("Ward's lobe never reflects more than it receives, and all of it when narrow and faced") {
    for (const double alpha : {0.05, 0.15, 0.4}) {
        for (const double theta : {0.0, 0.5, 1.0, 1.4, 1.52}) {
            const WardReflection lobe =
                ward(lobe_direction(theta, 0.2), alpha, std::sqrt(0.7) * alpha);
            const double albedo =
                half_sphere_integral([&](const Vec3& wi) { return lobe.eval(wi) * wi.z; });
            CAPTURE(alpha);
            CAPTURE(theta);
            CHECK(albedo <= 1 + kQuadrature);
            CHECK(albedo > 0.5);
            // Narrow lobes lose what the tail has below the horizon, and the normalisation by the
            // tangent's first order.
            if (alpha == 0.05 && theta < 1.2) CHECK(albedo == within(0.02, 1));
        }
    }
}

TEST_CASE("reciprocity: reflected and transmitted lobes are the same from wo to wi and back") {
    RandomStream random(3);
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = lobe_direction(1.5 * random.next(), 2 * kPi * random.next());
        const Vec3 b = lobe_direction(1.5 * random.next(), 2 * kPi * random.next());
        const double u = 0.1 + random.next(), v = 0.1 + random.next();
        CHECK(ward(a, u, v).eval(b) == rounded(ward(b, u, v).eval(a)));
        CHECK(ashikhmin(a, 9 * u, v).eval(b) == rounded(ashikhmin(b, 9 * u, v).eval(a)));
        // Seen from below, the surface's front is there. The cosine is included.
        const LobeFrame below{kFrame.u, -kFrame.v, -kFrame.n};
        const WardTransmission down = ward_through(a, u, v), up{b, b.z, below, u, v};
        CHECK(down.eval(-b) / b.z == rounded(up.eval(a) / a.z));
    }
}

TEST_CASE("Ward's transmitted lobe carries what it receives when narrow, and more at grazing") {
    const auto albedo = [](double theta, double alpha) {
        const WardTransmission lobe = ward_through(lobe_direction(theta, 1), alpha, alpha);
        return half_sphere_integral([&](const Vec3& wi) { return lobe.eval(wi); }, -1);
    };
    CHECK(albedo(0.3, 0.04) == within(0.01, 1));  // its tails
    for (const double alpha : {0.04, 0.2, 0.5})
        for (const double theta : {0.0, 0.6, 1.2}) CHECK(albedo(theta, alpha) <= 1 + kQuadrature);
    CHECK(albedo(1.52, 0.5) > 1.1);  // not bounded
}

TEST_CASE(
    "Ward's transmitted lobe of equal slopes is the isotropic one, and has its peak straight on") {
    const Vec3 wo = lobe_direction(0.3, 1), wi = -lobe_direction(0.45, 1.7);
    CHECK(ward_through(wo, 0.1, 0.2).eval(-wo) == rounded(1 / (kPi * 0.02)));
    const double cosines = std::sqrt(-wi.z / wo.z);
    CHECK(ward_through(wo, 0.3, 0.3).eval(wi) ==
          rounded(ward_transmission(-wo, wi, 0.09) * cosines));
    CHECK(ward_through(wo, 0.3, 0.3).eval(wi, 0.05) ==
          rounded(ward_transmission(-wo, wi, 0.14) * cosines));
    CHECK(std::abs(ward_through(wo, 0.2, 0.4).eval(wi) - ward_through(wo, 0.4, 0.2).eval(wi)) >
          0.01);
}

TEST_CASE("the Ashikhmin-Shirley lobe never reflects more than it receives") {
    for (const double theta : {0.0, 0.6, 1.2, 1.52}) {
        const AshikhminReflection lobe = ashikhmin(lobe_direction(theta, 0.9), 100, 40);
        const double albedo =
            half_sphere_integral([&](const Vec3& wi) { return lobe.eval(wi) * wi.z; });
        CAPTURE(theta);
        CHECK(albedo <= 1 + kQuadrature);
        if (theta < 1.3) CHECK(albedo > 0.7);  // and not an empty lobe
    }
}

TEST_CASE("the Ashikhmin-Shirley lobe has its peak where the half vector is the normal") {
    const AshikhminReflection lobe = ashikhmin(lobe_direction(0.5, 0), 50, 50);
    const double peak = lobe.eval(lobe_direction(0.5, kPi));
    CHECK(std::isfinite(peak));
    CHECK(peak == rounded(51 / (8 * kPi * lobe.cos_o * lobe.cos_o)));
    CHECK(lobe.eval(lobe_direction(0.6, kPi)) < peak);
}

TEST_CASE("a brushed frame follows its direction, and falls back where there is none") {
    const Vec3 n = lobe_direction(0.3, 0.8);
    const OrientedFrame f = orient({1, 2, 0.5}, n);
    CHECK(!f.isotropic);
    CHECK(dot(f.frame.u, n) == rounded(0));
    CHECK(dot(f.frame.u, f.frame.v) == rounded(0));
    CHECK(length(f.frame.u) == rounded(1));
    CHECK(dot(f.frame.u, Vec3{1, 2, 0.5}) > 0);
    CHECK(dot(f.frame.v, Vec3{1, 2, 0.5}) == rounded(0));
    CHECK(dot(cross(f.frame.u, f.frame.v), f.frame.n) == rounded(1));
    for (const Vec3& along : {Vec3{0, 0, 0}, Vec3{0, 0, 2}}) {
        const OrientedFrame none = orient(along, {0, 0, 1});
        CHECK(none.isotropic);
        CHECK(dot(cross(none.frame.u, none.frame.v), none.frame.n) == rounded(1));
    }
}

TEST_CASE("a light widens the lobe of flat surfaces, less when its samples are jittered") {
    CHECK(light_widening(4 * kPi, 0) == rounded(1));
    CHECK(light_widening(0.1, 0.5) == rounded(0.5 * light_widening(0.1, 0)));
    CHECK(light_widening(0.1, 1) == 0);
}

TEST_CASE(
    "half vectors are unit, facets have the slope they say, and the edges of the number range "
    "are safe") {
    const FacetSlope facet = sample_ward_facet(kFrame, 0.1, 0.3, 0.37, 0.2);
    CHECK(length_squared(facet.tangent) == rounded(facet.squared));
    CHECK(facet.tangent.z == 0);
    CHECK(sample_ward_facet(kFrame, 0.1, 0.3, 0.37, 0).squared == 1);
    CHECK(sample_ward_facet(kFrame, 0.1, 0.3, 0.37, 1).squared == 0);
    CHECK(length(*sample_ashikhmin_half(kFrame, 10, 500, 0.9, 0.3)) == rounded(1));
    CHECK(!sample_ashikhmin_half(kFrame, 10, 500, 0.9, 0));
}

TEST_CASE("samples of lobes are unit vectors on the right side of the surface, or nothing") {
    const Vec3 wo = lobe_direction(1.3, 0.4), ng = normalize(Vec3{0.1, 0.2, 1});
    RandomStream random(2);
    int none = 0;
    for (int i = 0; i < 500; ++i) {
        const double xi1 = random.next(), xi2 = random.next();
        const auto reflected = ward(wo, 0.5, 0.3).sample(ng, xi1, xi2);
        const auto phong = ashikhmin(wo, 5, 9).sample(ng, xi1, xi2);
        const auto through = ward_through(wo, 0.5, 0.3).sample(ng, xi1, xi2);
        for (const auto& wi : {reflected, phong}) {
            none += wi ? 0 : 1;
            if (wi) CHECK(dot(*wi, ng) > 0);
            if (wi) CHECK(length(*wi) == rounded(1));
        }
        if (through) CHECK(dot(*through, ng) < 0);
        if (through) CHECK(length(*through) == rounded(1));
    }
    CHECK(none > 100);
}

TEST_CASE("reflection off a facet is a unit direction at the mirror angle") {
    const Vec3 wo = normalize(Vec3{-1, -2, 3});
    const Vec3 half{0.1, -0.2, 1};
    const Vec3 wi = reflect_off(wo, half, length_squared(half));
    CHECK(length(wi) == rounded(1));
    CHECK(dot(wi, half) == rounded(dot(wo, half)));
}
