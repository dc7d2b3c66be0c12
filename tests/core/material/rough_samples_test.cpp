#include "core/material/rough_samples.h"

#include <doctest/doctest.h>

#include "tests/core/chi_square.h"
#include "tests/core/material/surroundings.h"
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

/// Any smooth, lopsided radiance.
double sky(const Vec3& wi) {
    return 1 + 0.5 * wi.x + 0.8 * wi.y * wi.y + 0.3 * wi.x * wi.z;
}

}  // namespace

TEST_CASE("weighted samples of Ward's lobe estimate the light that it reflects of a sky") {
    const Vec3 up{0, 0, 1};
    const WardReflection lobe{normalize(Vec3{-1, -0.4, 1.2}), kFrame, 0.2, 0.35};
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

TEST_CASE(
    "a panel's highlight is the integral of the lobe, sampled from the lobe or from the lamp") {
    // Seen at 40 degrees, in a black metal but for its lobe; the panel is where that is bright.
    const Vec3 wo = normalize(Vec3{-0.6, 0.2, 0.75});
    const std::string panel = " polygon panel 0 0 12 1.2 -.3 1.1 .9 -.3 1.4 .9 .7 1.4 1.2 .7 1.1\n";
    const Vec3 corner{1.2, -0.3, 1.1}, u{-0.3, 0, 0.3}, v{0, 1, 0};
    for (const auto& [material, alpha_u, alpha_v] :
         {std::tuple{"void metal m 0 0 5 1 1 1 1 .3\n", 0.3, 0.3},
          {"void metal2 m 4 1 0 0 . 0 6 1 1 1 1 .15 .4\n", 0.15, 0.4}}) {
        const WardReflection lobe{wo, kFrame, alpha_u, alpha_v};
        const double area = length(cross(u, v));
        const double expected = integrate(
            [&](double x, double y) {
                const Vec3 way = corner + u * x + v * y, wi = normalize(way);
                const double cosine = std::abs(dot(cross(u, v), wi)) / area;
                return lobe.eval(wi) * wi.z * cosine * area / length_squared(way);
            },
            0, 1, 0, 1, 1e-9);
        CAPTURE(std::string(material));
        for (const bool by_lamp : {false, true}) {
            RenderOptions options = TestScene::exact();
            options.specular_threshold = 0;
            options.weight_limit = 1e-9;
            options.specular_samples = 1500;
            options.source_jitter = 1;
            options.source_subdivision = 0.05;
            const std::string light =
                by_lamp ? "void light bright 0 0 3 1 1 1\n" : "void glow bright 0 0 4 1 1 1 0\n";
            TestScene scene(light + "bright" + panel + material + sheet("floor"), options);
            Statistics shown;
            for (std::uint32_t i = 0; i < 60; ++i)
                shown.add(static_cast<double>(scene.trace(wo, -wo, i).value.g));
            CAPTURE(by_lamp);
            CAPTURE(expected);
            CAPTURE(shown.mean());
            REQUIRE(shown.error() < 0.02 * expected);
            CHECK(std::abs(shown.mean() - expected) < 4 * shown.error() + 1e-6 * expected);
        }
    }
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
