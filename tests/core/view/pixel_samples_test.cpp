#include "core/view/pixel_samples.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/math/random.h"
#include "core/math/vec3.h"
#include "tests/core/chi_square.h"

using namespace lightwalk;

namespace {

std::vector<PixelOffset> samples_of(int x, int y, int count) {
    std::vector<PixelOffset> samples;
    for (int s = 0; s < count; ++s) {
        RandomStream random =
            RandomStream::of_pixel(1, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                   static_cast<std::uint32_t>(s));
        samples.push_back(pixel_sample(1, x, y, s, count, random.next()));
    }
    return samples;
}

double radius(const PixelOffset& at) {
    return std::hypot(at.x, at.y);
}

/// Weight of the filter to the left of x: the integral of its Gaussian.
double weight_left_of(double x) {
    return 0.5 * (1 + std::erf(x / kPixelFilterRadius));
}

}  // namespace

TEST_CASE("samples are distributed as the Gaussian of .6 pixels, in every direction") {
    constexpr int kPixels = 100;
    constexpr int kCount = 16;
    constexpr double kSamples = kPixels * kPixels * kCount;
    for (const double direction : {0.0, 0.7, 1.6}) {
        for (const double edge : {-0.5, 0.0, 0.2, 0.9}) {
            CAPTURE(direction);
            CAPTURE(edge);
            double left = 0;
            for (int i = 0; i < kPixels * kPixels; ++i) {
                for (const PixelOffset& at : samples_of(i % kPixels, i / kPixels, kCount))
                    left += at.x * std::cos(direction) + at.y * std::sin(direction) < edge ? 1 : 0;
            }
            const double p = weight_left_of(edge);
            // Independent samples would have this standard error; stratified ones have less.
            CHECK(std::abs(left / kSamples - p) < 4 * std::sqrt(p * (1 - p) / kSamples));
        }
    }
}

TEST_CASE("each ring of equal weight has one sample, the first being the nearest") {
    for (const int count : {2, 7, 16}) {
        for (int x = 0; x < 50; ++x) {
            const std::vector<PixelOffset> samples = samples_of(x, 3, count);
            for (int s = 0; s < count; ++s) {
                const double r = radius(samples[static_cast<std::size_t>(s)]) / kPixelFilterRadius;
                const double inside = 1 - std::exp(-r * r);
                CHECK(inside * count >= s - 1e-9);  // rounding of logarithm and exponential
                CHECK(inside * count <= s + 1 + 1e-9);
                if (s > 0)
                    CHECK(radius(samples[0]) <= radius(samples[static_cast<std::size_t>(s)]));
            }
        }
    }
}

TEST_CASE("a pixel's mean over an edge varies less than that of independent samples") {
    constexpr int kPixels = 4000;
    for (const int count : {4, 9, 16, 64}) {
        for (const double edge : {0.0, 0.3}) {
            CAPTURE(count);
            CAPTURE(edge);
            const double p = weight_left_of(edge);
            double squares = 0;
            for (int x = 0; x < kPixels; ++x) {
                double left = 0;
                for (const PixelOffset& at : samples_of(x, 7, count)) left += at.x < edge ? 1 : 0;
                squares += (left / count - p) * (left / count - p);
            }
            const double independent = p * (1 - p) / count;
            CHECK(squares / kPixels < 0.5 * independent);
        }
    }
}

TEST_CASE("the samples of a pixel are the same each time, pixels and seeds have their own") {
    const PixelOffset a = pixel_sample(1, 5, 6, 3, 8, 0.25);
    const PixelOffset b = pixel_sample(1, 5, 6, 3, 8, 0.25);
    CHECK(a.x == b.x);
    CHECK(a.y == b.y);
    CHECK(a.x != pixel_sample(1, 6, 5, 3, 8, 0.25).x);
    CHECK(a.x != pixel_sample(2, 5, 6, 3, 8, 0.25).x);
    CHECK(radius(a) == doctest::Approx(radius(pixel_sample(2, 5, 6, 3, 8, 0.25))));
    CHECK(std::isfinite(pixel_sample(1, 0, 0, 7, 8, 1 - 0x1p-53).x));
}

TEST_CASE("the Gaussian is that of .6 pixels, and ends where less than half a per cent is left") {
    const auto filter = [](double d) { return pixel_filter(PixelFilter::gaussian, d); };
    constexpr double kReach = pixel_filter_reach(PixelFilter::gaussian);
    CHECK(filter(0) == 1);
    CHECK(filter(0.6) == doctest::Approx(std::exp(-1)));
    CHECK(filter(-1.2) == doctest::Approx(std::exp(-4)));
    const double kept = std::erf(kReach / kPixelFilterRadius);
    CHECK(1 - kept * kept < 0.005);
}

TEST_CASE("Mitchell's filter is the cubic of B = C = 1/3 of its paper") {
    const auto filter = [](double d) { return pixel_filter(PixelFilter::mitchell, d); };
    // Equation 8 with B = C = 1/3, piece by piece.
    constexpr double kB = 1.0 / 3, kC = 1.0 / 3;
    for (const double x : {0.0, .3, .5, .99, 1.0, 1.2, 1.6, 1.99}) {
        CAPTURE(x);
        const double inner =
            (12 - 9 * kB - 6 * kC) * x * x * x + (-18 + 12 * kB + 6 * kC) * x * x + (6 - 2 * kB);
        const double outer = (-kB - 6 * kC) * x * x * x + (6 * kB + 30 * kC) * x * x +
                             (-12 * kB - 48 * kC) * x + (8 * kB + 24 * kC);
        CHECK(filter(x) == doctest::Approx((x < 1 ? inner : outer) / 6));
        CHECK(filter(-x) == filter(x));
        CHECK((filter(x) < 0) == (x > 8.0 / 7));
        CHECK(filter(x) > -.0364);
    }
}

TEST_CASE(
    "a place counts for pixels as much as for all of the picture: their weights' sum is one") {
    for (int i = 0; i <= 40; ++i) {
        const double at = i / 40.0 - .5;
        CAPTURE(at);
        const auto sum = [at](PixelFilter filter) {
            double weights = 0;
            for (int pixel = -4; pixel <= 4; ++pixel) weights += pixel_filter(filter, at - pixel);
            return weights;
        };
        CHECK(sum(PixelFilter::mitchell) == doctest::Approx(1).epsilon(1e-12));
        // The Gaussian's is so on average, and nowhere far from it.
        CHECK(sum(PixelFilter::gaussian) ==
              doctest::Approx(kPixelFilterRadius * std::sqrt(kPi)).epsilon(.08));
    }
}

TEST_CASE("a filter reaches the pixels that it says, and no farther") {
    for (const PixelFilter filter : {PixelFilter::gaussian, PixelFilter::mitchell}) {
        const double reach = pixel_filter_reach(filter);
        CHECK(pixel_filter(filter, reach) == 0);
        CHECK(pixel_filter(filter, -reach) == 0);
        CHECK(pixel_filter(filter, reach - .01) != 0);
        // Of samples that lie up to half a pixel from their own pixel's centre.
        CHECK(reach <= reached_pixels(filter) + .5);
        CHECK(reach > reached_pixels(filter) - .5);
        CHECK(std::isfinite(pixel_filter(filter, 1e300)));
    }
    CHECK(has_negative_weights(PixelFilter::mitchell));
    CHECK_FALSE(has_negative_weights(PixelFilter::gaussian));
}

TEST_CASE("shared samples lie in their pixel, one in each cell of the grid that their number has") {
    for (const auto& [count, columns, rows] : std::vector<std::array<int, 3>>{
             {2, 1, 1}, {4, 1, 1}, {5, 1, 1}, {6, 2, 3}, {9, 3, 3}, {12, 3, 4}, {14, 1, 1}}) {
        CAPTURE(count);
        std::vector<int> cells(static_cast<std::size_t>(columns * rows), 0);
        for (int s = 0; s < count; ++s) {
            for (const double u : {0.0, 0.3, 1 - 0x1p-32}) {
                const PixelOffset at = shared_sample(s, count, {u, 1 - 0x1p-32 - u});
                REQUIRE(std::max(std::abs(at.x), std::abs(at.y)) <= 0.5);
                const int column = static_cast<int>((at.x + 0.5) * columns);
                const int row = static_cast<int>((at.y + 0.5) * rows);
                ++cells[static_cast<std::size_t>(row * columns + column)];
            }
        }
        CHECK(*std::min_element(cells.begin(), cells.end()) ==
              *std::max_element(cells.begin(), cells.end()));
    }
}

TEST_CASE("shared samples are uniform in their pixel, whatever their number") {
    const lightwalk::test::UnitSquareCells cells{18, 18};
    const auto masses = lightwalk::test::cell_masses(cells, [](double, double) { return 1.0; });
    for (const int count : {4, 6, 7, 9}) {
        CAPTURE(count);
        const auto counts = lightwalk::test::count_cells(
            cells, masses, 20000, 3,
            [&](RandomStream& random) -> std::optional<lightwalk::test::SquarePoint> {
                const int sample = static_cast<int>(random.next() * count);
                const PixelOffset at = shared_sample(sample, count, random.next_pair());
                return lightwalk::test::SquarePoint{at.x + 0.5, at.y + 0.5};
            });
        CHECK(agrees(chi_square(counts)));
    }
}
