#include "core/ambient/refined_hemisphere.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Form factor from a small surface to a square that lies parallel above its centre.
/// @param half  half the square's side, in its distance
double square_above(double half) {
    const double root = std::sqrt(1 + half * half);
    return 4 * half / (kPi * root) * std::atan(half / root);
}

/// A square that shines down with a radiance of 1, at a height of 1 in the dark.
struct ShiningSquare {
    explicit ShiningSquare(double half)
        : scene(
              "void glow shine 0 0 4 1 1 1 0 void plastic black 0 0 5 0 0 0 0 0 "
              "black bubble room 0 0 4 0 0 0 9 shine polygon square 0 0 12 " +
              corner(half, half) + corner(half, -half) + corner(-half, -half) +
              corner(-half, half)) {
        for (std::size_t i = 0; i < scene.scene.modifier_count(); ++i) {
            const ModifierId id{static_cast<std::int32_t>(i)};
            lets_light.push_back(scene.scene.modifier(id).name == "shine" ? 1 : 0);
        }
    }
    static std::string corner(double x, double y) {
        return std::to_string(x) + " " + std::to_string(y) + " 1 ";
    }
    double sample(int finer, std::uint64_t seed) {
        Ray parent;
        parent.hit.t = 1;
        parent.hit.normal = {0, 0, 1};
        parent.history = kPrimary;
        RefinedHemisphere::Sampling sampling;
        sampling.normal = {0, 0, 1};
        sampling.divisions = 8;
        sampling.finer = finer;
        sampling.coef = {1, 1, 1};
        sampling.share = 1.0f / 64;
        sampling.random = RandomStream::of_pixel(seed, 0, 0, 0);
        RefinedHemisphere hemisphere(scene.tracer, lets_light, parent, sampling, scene.context);
        return static_cast<double>(hemisphere.sample().sum[1]);
    }
    struct Statistics {
        double mean = 0, deviation = 0;  ///< deviation of one sample
    };
    Statistics statistics(int finer, int count) {
        double sum = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
            const double value = sample(finer, static_cast<std::uint64_t>(i));
            sum += value;
            squares += value * value;
        }
        const double mean = sum / count;
        return {mean, std::sqrt(squares / count - mean * mean)};
    }

    TestScene scene;
    std::vector<std::uint8_t> lets_light;
};

}  // namespace

TEST_CASE(
    "refined hemisphere: its mean is the form factor, of squares smaller than a cell as well") {
    for (const double half : {0.06, 0.15, 0.6}) {
        ShiningSquare square(half);
        for (const int finer : {1, 2, 3}) {
            CAPTURE(half);
            CAPTURE(finer);
            constexpr int kCount = 1500;
            const ShiningSquare::Statistics found = square.statistics(finer, kCount);
            CHECK(found.deviation > 0);
            CHECK(std::abs(found.mean - square_above(half)) <
                  3.5 * found.deviation / std::sqrt(double{kCount}));
        }
    }
}

TEST_CASE("refined hemisphere: cells next to light have less noise") {
    ShiningSquare square(0.6);
    CHECK(square.statistics(3, 300).deviation < 0.45 * square.statistics(1, 300).deviation);
}
