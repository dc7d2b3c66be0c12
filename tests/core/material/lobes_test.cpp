#include "core/material/lobes.h"

#include <doctest/doctest.h>

#include "core/material/orientation.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

Vec3 at_angles(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Integral over the hemisphere about +z (times `side`) of a function of direction, midpoint rule
/// in (θ, φ).
template <class F>
double hemisphere_integral(const F& f, double side = 1) {
    constexpr int kRows = 700, kColumns = 700;
    double sum = 0;
    for (int i = 0; i < kRows; ++i) {
        const double theta = (i + 0.5) * kPi / 2 / kRows;
        for (int j = 0; j < kColumns; ++j) {
            Vec3 l = at_angles(theta, (j + 0.5) * 2 * kPi / kColumns);
            l.z *= side;
            sum += f(l) * std::sin(theta);
        }
    }
    return sum * (kPi / 2 / kRows) * (2 * kPi / kColumns);
}

const LobeFrame kFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

}  // namespace

TEST_CASE("Ward's lobe peaks at 1 / (4 pi alpha² cos²) in the mirror direction") {
    for (const double theta : {0.0, 0.6, 1.2}) {
        const Vec3 h = at_angles(theta, 0) + at_angles(theta, kPi);
        const double c = std::cos(theta);
        CHECK(ward_reflection(h, kFrame.n, 0.02) * 4 * kPi * 0.02 * c * c == rounded(1));
        CHECK(ward_reflection(h, kFrame, 0.01, 0.04) * 4 * kPi * 0.02 * c * c == rounded(1));
    }
}

TEST_CASE("Ward's lobe of equal slopes is the isotropic one, and turns with its frame") {
    const Vec3 h = at_angles(0.7, 1.9) * 1.3;
    CHECK(ward_reflection(h, kFrame, 0.4, 0.4) == rounded(ward_reflection(h, kFrame.n, 0.4)));
    const LobeFrame turned{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    CHECK(ward_reflection({-h.y, h.x, h.z}, turned, 0.5, 2) ==
          rounded(ward_reflection(h, kFrame, 0.5, 2)));
    CHECK(std::abs(ward_reflection(h, turned, 0.5, 2) - ward_reflection(h, kFrame, 0.5, 2)) > 0.01);
}

TEST_CASE("Ward's lobe never reflects more than it receives, and all of it when narrow and faced") {
    for (const double alpha : {0.05, 0.15, 0.4}) {
        for (const double theta : {0.0, 0.5, 1.0, 1.4}) {
            const Vec3 eye = at_angles(theta, 0.2);
            const double albedo = hemisphere_integral([&](const Vec3& l) {
                return ward_reflection(l + eye, kFrame, alpha * alpha, 0.7 * alpha * alpha) * l.z;
            });
            CAPTURE(alpha);
            CAPTURE(theta);
            CHECK(albedo <= 1.001);  // 1, and the quadrature's error
            // Narrow lobes lose what the tail has below the horizon, and the normalisation by the
            // tangent's first order.
            if (alpha == 0.05 && theta < 1.2) CHECK(albedo == within(0.02, 1));
        }
    }
}

TEST_CASE("Ward's transmitted lobe carries what it receives when narrow") {
    // The lobes come without their cosines: sqrt(cos_l / cos_v) is 1 along the axis.
    const Vec3 w = at_angles(0.3, 1) * -1.0;
    const double cos_v = -w.z;
    const double alpha2 = 0.0016;
    const auto weighted = [&](double lobe, const Vec3& l) {
        return lobe * std::sqrt(-l.z / cos_v);
    };
    const double isotropic = hemisphere_integral(
        [&](const Vec3& l) { return weighted(ward_transmission(w, l, alpha2), l); }, -1);
    CHECK(isotropic == within(0.01, 1));  // its tails, as above
    CHECK(ward_transmission(w - w, kFrame, 0.01, 0.04) == rounded(1 / (kPi * 0.02)));
    // Straight through, the brushed lobe of equal slopes is the isotropic one but for |h|² = 2 - 2
    // w·l.
    const Vec3 straight{0, 0, -1};
    const Vec3 l = at_angles(kPi - 0.05, 0.4);
    CHECK(ward_transmission(l - straight, kFrame, alpha2, alpha2) ==
          rounded(ward_transmission(straight, l, alpha2)));
}

TEST_CASE("the Ashikhmin-Shirley lobe is reciprocal and bounded") {
    const Vec3 a = at_angles(0.4, 0.3), b = at_angles(1.1, 2.5);
    CHECK(ashikhmin_reflection(a, -b, b.z, kFrame, 3, 7) ==
          rounded(ashikhmin_reflection(b, -a, a.z, kFrame, 3, 7)));
    for (const double theta : {0.0, 0.6, 1.2}) {
        const Vec3 eye = at_angles(theta, 0.9);
        const double albedo = hemisphere_integral([&](const Vec3& l) {
            return ashikhmin_reflection(l, -eye, eye.z, kFrame, 100, 40) * l.z;
        });
        CAPTURE(theta);
        CHECK(albedo <= 1.001);  // 1, and the quadrature's error
        CHECK(albedo > 0.7);     // and not an empty lobe
    }
}

TEST_CASE("the Ashikhmin-Shirley lobe has its peak where the half vector is the normal") {
    const Vec3 eye = at_angles(0.5, 0);
    const Vec3 mirrored = at_angles(0.5, kPi);
    const double peak = ashikhmin_reflection(mirrored, -eye, eye.z, kFrame, 50, 50);
    CHECK(std::isfinite(peak));
    CHECK(peak == rounded(51 / (8 * kPi * eye.z * eye.z)));
    CHECK(ashikhmin_reflection(at_angles(0.6, kPi), -eye, eye.z, kFrame, 50, 50) < peak);
}

TEST_CASE("a brushed frame follows its direction, and falls back where there is none") {
    const Vec3 n = at_angles(0.3, 0.8);
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
