#include "core/math/student_t.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/math/random.h"

using namespace lightwalk;

namespace {

/// Of Student's distribution: the probability between -t and t. Its density by Simpson's rule.
double probability_within(double t, int degrees) {
    const double n = degrees;
    const double scale =
        std::exp(std::lgamma((n + 1) / 2) - std::lgamma(n / 2)) / std::sqrt(n * std::acos(-1.0));
    const auto density = [&](double x) { return scale * std::pow(1 + x * x / n, -(n + 1) / 2); };
    constexpr int kSteps = 2000;
    const double h = t / kSteps;
    double sum = density(0) + density(t);
    for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4 : 2) * density(i * h);
    return 2 * sum * h / 3;
}

}  // namespace

TEST_CASE("Student's t: what printed tables have") {
    // Three decimals, as in every textbook's table since Fisher's, "Statistical Methods for
    // Research Workers" (1925), table IV: the column P = .05.
    const std::vector<std::pair<int, double>> table{
        {1, 12.706},  {2, 4.303},   {3, 3.182},   {4, 2.776},  {5, 2.571},  {9, 2.262},
        {10, 2.228},  {15, 2.131},  {20, 2.086},  {25, 2.060}, {29, 2.045}, {30, 2.042},
        {31, 2.040},  {40, 2.021},  {50, 2.009},  {60, 2.000}, {80, 1.990}, {99, 1.984},
        {100, 1.984}, {120, 1.980}, {1000, 1.962}};
    for (const auto& [degrees, t] : table) {
        CAPTURE(degrees);
        CHECK(std::abs(student_t_95(degrees) - t) < 0.0005 + 1e-9);
    }
}

TEST_CASE("Student's t: 95 % of the distribution lie within") {
    for (int degrees = 1; degrees < 200; ++degrees) {
        CAPTURE(degrees);
        // The density at the quantile is at most .06, a unit of the fifth decimal 1.2e-6 of it.
        CHECK(probability_within(student_t_95(degrees), degrees) ==
              doctest::Approx(.95).epsilon(2e-6));
    }
}

TEST_CASE("intervals of means: 95 % hold the mean of normal answers, of few as of many") {
    constexpr int kTries = 20000;
    for (const int count : {2, 3, 8, 40}) {
        CAPTURE(count);
        int held = 0;
        RandomStream random(static_cast<std::uint64_t>(count));
        for (int i = 0; i < kTries; ++i) {
            std::vector<double> answers;
            for (int k = 0; k < count; ++k) {  // Box & Muller 1958
                const double radius = std::sqrt(-2 * std::log(1 - random.next()));
                answers.push_back(7 + radius * std::cos(2 * std::acos(-1.0) * random.next()));
            }
            const MeanInterval interval = mean_interval(answers);
            held += std::abs(interval.mean - 7) <= interval.half_width ? 1 : 0;
        }
        // Five standard deviations of a count are .0077.
        CHECK(double(held) / kTries == doctest::Approx(.95).epsilon(.0077 / .95));
    }
}

TEST_CASE("intervals of means: equal answers leave none, large ones lose no digits") {
    const std::vector<double> equal(5, .1), large{1e9 + 1, 1e9 + 2, 1e9 + 3};
    CHECK(mean_interval(equal).mean == .1);
    CHECK(mean_interval(equal).half_width == 0);
    CHECK(mean_interval(large).mean == 1e9 + 2);
    CHECK(mean_interval(large).half_width == doctest::Approx(4.302653 / std::sqrt(3.0)));
    const std::vector<double> two{1, 2};  // t s / sqrt(2), s = 1 / sqrt(2)
    CHECK(mean_interval(two).half_width == doctest::Approx(12.706205 / 2));
}

TEST_CASE("intervals of means: batches of one answer are answers, those of equal ones leave none") {
    const std::vector<double> answers{3, 5, 4, 8};
    const std::vector<AnswerBatch> batches{{3, 1}, {5, 1}, {0, 0}, {4, 1}, {8, 1}};
    const MeanInterval wanted = mean_interval(answers), told = mean_interval(batches);
    CHECK(told.mean == doctest::Approx(wanted.mean));
    CHECK(told.half_width == doctest::Approx(wanted.half_width));
    const std::vector<AnswerBatch> equal{{.1, 3}, {.1, 2}}, one{{.1, 7}, {0, 0}};
    CHECK(mean_interval(equal).mean == .1);
    CHECK(mean_interval(equal).half_width == 0);
    CHECK(mean_interval(one).mean == .1);
    CHECK(std::isinf(mean_interval(one).half_width));
}

TEST_CASE("intervals of means: of batches of different size 95 % hold the mean") {
    constexpr int kTries = 20000;
    int held = 0;
    RandomStream random(5);
    for (int i = 0; i < kTries; ++i) {
        std::vector<AnswerBatch> batches;
        for (const int count : {1, 1, 1, 2, 2, 2, 2, 9}) {
            AnswerBatch& batch = batches.emplace_back();
            batch.count = count;
            // The sum of 12 uniform numbers is nearly normal, of variance 1.
            for (int k = 0; k < 12 * count; ++k) batch.mean += (random.next() - .5) / count;
        }
        const MeanInterval interval = mean_interval(batches);
        held += std::abs(interval.mean) <= interval.half_width ? 1 : 0;
    }
    CHECK(double(held) / kTries == doctest::Approx(.95).epsilon(.0077 / .95));
}
