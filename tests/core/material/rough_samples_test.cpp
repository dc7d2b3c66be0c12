#include "core/material/rough_samples.h"

#include <doctest/doctest.h>

#include "tests/core/chi_square.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const LobeFrame kLevelFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

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

/// Any smooth, lopsided radiance.
double sky(const Vec3& wi) {
    return 1 + 0.5 * wi.x + 0.8 * wi.y * wi.y + 0.3 * wi.x * wi.z;
}

}  // namespace

TEST_CASE("weighted samples of Ward's lobe estimate the light that it reflects of a sky") {
    const Vec3 up{0, 0, 1};
    const WardReflection lobe{normalize(Vec3{-1, -0.4, 1.2}), kLevelFrame, 0.2, 0.35};
    const double expected = sphere_integral(DirectionCells{up, 1, 40, 40}, [&](const Vec3& wi) {
        return wi.z > 0 ? lobe.eval(wi) * wi.z * sky(wi) : 0;
    });
    RandomStream random(11);
    Statistics estimate;
    for (int i = 0; i < 200000; ++i) {
        const double xi1 = random.next();
        const std::optional<Vec3> wi = lobe.sample(up, xi1, random.next());
        estimate.add(wi ? WardReflection::weight(lobe.wo.z, wi->z) * sky(*wi) : 0);
    }
    REQUIRE(estimate.error() < 0.005 * expected);
    CHECK(std::abs(estimate.mean() - expected) <
          4 * estimate.error() + 1e-5);  // the integral's own error
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
