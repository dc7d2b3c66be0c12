#include "core/material/rough_samples.h"

#include <doctest/doctest.h>

#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const LobeFrame kFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// Running mean and its standard error.
struct Statistics {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
        ++count;
    }
    [[nodiscard]] double mean() const { return sum / count; }
    [[nodiscard]] double error() const {
        return std::sqrt((squares / count - mean() * mean()) / count);
    }
};

template <class F>
double hemisphere_integral(const F& f) {
    constexpr int kRows = 900, kColumns = 900;
    double sum = 0;
    for (int i = 0; i < kRows; ++i) {
        const double theta = (i + 0.5) * kPi / 2 / kRows;
        for (int j = 0; j < kColumns; ++j) {
            const double phi = (j + 0.5) * 2 * kPi / kColumns;
            sum += f(Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                          std::cos(theta)}) *
                   std::sin(theta);
        }
    }
    return sum * (kPi / 2 / kRows) * (2 * kPi / kColumns);
}

/// Any smooth, lopsided radiance.
double sky(const Vec3& l) {
    return 1 + 0.5 * l.x + 0.8 * l.y * l.y + 0.3 * l.x * l.z;
}

}  // namespace

TEST_CASE(
    "Ward facets reflect with the density of the lobe: weighted samples estimate its integral") {
    const double au = 0.2, av = 0.35;
    const Vec3 v = normalize(Vec3{1, 0.4, -1.2});
    const double expected = hemisphere_integral([&](const Vec3& l) {
        return ward_reflection(l - v, kFrame, au * au, av * av) * l.z * sky(l);
    });
    RandomStream random(11);
    Statistics estimate;
    for (int i = 0; i < 200000; ++i) {
        const double xi1 = random.next();
        const FacetSlope facet = sample_ward_facet(kFrame, au, av, xi1, random.next());
        const Vec3 l = reflect_off(v, kFrame.n + facet.tangent, 1 + facet.squared);
        estimate.add(l.z > 0 ? 2 / (1 - v.z / l.z) * sky(l) : 0);
    }
    REQUIRE(estimate.error() < 0.005 * expected);
    CHECK(std::abs(estimate.mean() - expected) <
          4 * estimate.error() + 1e-4);  // the integral's own error
}

TEST_CASE("Ashikhmin-Shirley half vectors have the published density") {
    const double nu = 25, nv = 90;
    const auto g = [](const Vec3& h) { return h.x * h.x + 3 * h.y * h.y + h.z; };
    const double expected = hemisphere_integral([&](const Vec3& h) {
        const double power = (nu * h.x * h.x + nv * h.y * h.y) / (1 - h.z * h.z);
        return std::sqrt((nu + 1) * (nv + 1)) / (2 * kPi) * std::pow(h.z, power) * g(h);
    });
    RandomStream random(12);
    Statistics estimate;
    for (int i = 0; i < 200000; ++i) {
        const double xi1 = random.next();
        const std::optional<Vec3> h = sample_ashikhmin_half(kFrame, nu, nv, xi1, random.next());
        REQUIRE(h);
        estimate.add(g(*h));
    }
    CHECK(std::abs(estimate.mean() - expected) <
          4 * estimate.error() + 1e-5);  // the integral's own error
}

TEST_CASE(
    "half vectors are unit, facets have the slope they say, and the edges of the number range are "
    "safe") {
    const FacetSlope facet = sample_ward_facet(kFrame, 0.1, 0.3, 0.37, 0.2);
    CHECK(length_squared(facet.tangent) == rounded(facet.squared));
    CHECK(facet.tangent.z == 0);
    CHECK(sample_ward_facet(kFrame, 0.1, 0.3, 0.37, 0).squared == 1);
    CHECK(sample_ward_facet(kFrame, 0.1, 0.3, 0.37, 1).squared == 0);
    CHECK(length(*sample_ashikhmin_half(kFrame, 10, 500, 0.9, 0.3)) == rounded(1));
    CHECK(!sample_ashikhmin_half(kFrame, 10, 500, 0.9, 0));
}

TEST_CASE("reflection off a facet is a unit direction at the mirror angle") {
    const Vec3 v = normalize(Vec3{1, 2, -3});
    const Vec3 half{0.1, -0.2, 1};
    const Vec3 l = reflect_off(v, half, length_squared(half));
    CHECK(length(l) == rounded(1));
    CHECK(dot(l, half) == rounded(-dot(v, half)));
}

TEST_CASE("-ss below 1 narrows the lobe to its centre, from 1 on it does not") {
    CHECK(narrowed(0.3, 0) == 1);
    CHECK(narrowed(0.3, 0.5) == rounded(0.85));
    CHECK(narrowed(0.3, 1) == 0.3);
    CHECK(narrowed(0.3, 8) == 0.3);
}

TEST_CASE("the number of samples follows -ss and the weights") {
    RenderOptions options;
    options.weight_limit = 1e-3;
    options.specular_samples = 1.5;
    CHECK(rough_sample_count(options, 1, 1) == 1);
    options.specular_samples = 16;
    CHECK(rough_sample_count(options, 1, 0.5) == 16);
    CHECK(rough_sample_count(options, 0.25, 0.1) == 4);
    CHECK(rough_sample_count(options, 0.01, 0.01) == 1);
    CHECK(rough_sample_count(options, 1, 0.005) == 5);  // no lighter than the limit
    CHECK(rough_sample_count(options, 1, 0.0005) == 1);
    options.weight_limit = 0;
    options.specular_samples = 1e300;
    CHECK(rough_sample_count(options, 1, 1) > 1000);  // bounded, not overflowing
}
