#include "core/light/hit_rates.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/light/direct_calculation.h"
#include "core/math/random.h"

using namespace lightwalk;

namespace {

std::vector<float> remaining_sums_of(const std::vector<float>& brightness) {
    std::vector<float> remaining_sums(brightness.size() + 1, 0.0f);
    for (std::size_t i = brightness.size(); i-- > 0;)
        remaining_sums[i] = remaining_sums[i + 1] + brightness[i];
    return remaining_sums;
}

/// How many of these would be tested if all get through.
std::size_t tested(const std::vector<float>& brightness, double certainty, double threshold) {
    ShadowTally tally;
    return test_brightest(remaining_sums_of(brightness), certainty, threshold, tally,
                          [&](std::size_t first, std::size_t last) {
                              for (std::size_t i = first; i < last; ++i)
                                  tally.brightness += brightness[i];
                          });
}

/// Points that see `sources` sources of random brightness, each blocked with its own probability.
std::vector<MeasuredPoint> random_points(std::size_t count, const std::vector<double>& visibility,
                                         RandomStream random) {
    std::vector<MeasuredPoint> points(count);
    for (MeasuredPoint& point : points) {
        float total = 0;
        for (std::size_t s = 0; s < visibility.size(); ++s) {
            const auto b = static_cast<float>(std::pow(random.next(), 6.0));
            total += b;
            point.push_back(
                {static_cast<std::int32_t>(s), b, random.next() < visibility[s] ? b : 0.0f});
        }
        for (MeasuredCandidate& c : point) {
            c.brightness /= total;
            c.arriving /= total;
        }
        std::sort(point.begin(), point.end(),
                  [](const MeasuredCandidate& a, const MeasuredCandidate& b) {
                      return a.brightness > b.brightness;
                  });
    }
    return points;
}

/// Direct light as -dt estimates it, mean over the points; and how many tests that took.
struct Outcome {
    double light = 0;
    std::size_t tests = 0, candidates = 0;
};
Outcome estimate(const std::vector<MeasuredPoint>& points, const std::vector<float>& rates,
                 double threshold) {
    Outcome outcome;
    for (const MeasuredPoint& point : points) {
        std::vector<float> brightness;
        brightness.reserve(point.size());
        for (const MeasuredCandidate& c : point) brightness.push_back(c.brightness);
        ShadowTally tally;
        const auto rate = [&](std::size_t i) {
            return static_cast<double>(rates[static_cast<std::size_t>(point[i].source)]);
        };
        const std::size_t done = test_brightest(remaining_sums_of(brightness), 0.5, threshold,
                                                tally, [&](std::size_t first, std::size_t last) {
                                                    for (std::size_t i = first; i < last; ++i) {
                                                        tally.hits += point[i].arriving > 0 ? 1 : 0;
                                                        tally.expected += rate(i);
                                                        tally.brightness += point[i].arriving;
                                                    }
                                                });
        outcome.light += static_cast<double>(tally.brightness);
        for (std::size_t i = done; i < point.size(); ++i) {
            outcome.light +=
                static_cast<double>(point[i].brightness) * std::min(1.0, tally.factor() * rate(i));
        }
        outcome.tests += done;
        outcome.candidates += point.size();
    }
    outcome.light /= static_cast<double>(points.size());
    return outcome;
}

}  // namespace

TEST_CASE("-dt stops when the next candidates cannot matter, never before the first block") {
    std::vector<float> falling;
    for (int i = 0; i < 100; ++i) falling.push_back(std::pow(0.7f, static_cast<float>(i)));
    CHECK(tested(falling, 1, 0) == 100);
    CHECK(tested(falling, 1, 1e9) == kFirstBlock);
    CHECK(tested(falling, 1, 0.05) == kFirstBlock + kNextBlocks);
    CHECK(tested({3, 2, 1}, 0.5, 1e9) == 3);
    CHECK(tested({}, 0.5, 0.1) == 0);
    // With -dc 0 one candidate is looked at ahead, with -dc 1 all that are left.
    const std::vector<float> equal(100, 1.0f);
    CHECK(tested(equal, 0, 0.3) == kFirstBlock);
    CHECK(tested(equal, 1, 0.3) > kFirstBlock);
    CHECK(tested(equal, 1e9, 0.3) == tested(equal, 1, 0.3));
}

TEST_CASE("frozen hit rates: the mean light with -dt is that of testing every source") {
    const std::vector<double> visibility{0.9, 0.1, 0.5, 1, 0, 0.3, 0.8, 0.6, 0.2, 0.7, 0.95, 0.4,
                                         0.9, 0.1, 0.5, 1, 0, 0.3, 0.8, 0.6, 0.2, 0.7, 0.95, 0.4};
    const auto measured = random_points(2000, visibility, RandomStream(1));
    const auto rendered = random_points(20000, visibility, RandomStream(2));
    for (const double threshold : {0.05, 0.2}) {
        CAPTURE(threshold);
        const std::vector<float> rates = fit_hit_rates(measured, visibility.size(), 0.5, threshold);
        const Outcome all = estimate(rendered, rates, 0),
                      some = estimate(rendered, rates, threshold);
        CHECK(all.tests == all.candidates);
        CHECK(some.tests < all.tests);  // else the estimate is not tried
        // Half a percent is what -dt may cost in the mean, by our own promise.
        CHECK(std::abs(some.light / all.light - 1) < 0.005);
        const std::vector<float> ignorant(visibility.size(), 1.0f);
        CHECK(std::abs(estimate(rendered, ignorant, threshold).light / all.light - 1) >
              std::abs(some.light / all.light - 1));
    }
}

TEST_CASE("frozen hit rates lie in 0 ... 1, sources that nothing is known of count half") {
    const std::vector<float> none = fit_hit_rates({}, 3, 0.5, 0.05);
    CHECK(none == std::vector<float>{0.5f, 0.5f, 0.5f});
    const auto points = random_points(50, {1, 0, 0.5}, RandomStream(3));
    for (const float rate : fit_hit_rates(points, 3, 0.5, 0.05)) {
        CHECK(rate >= 0);
        CHECK(rate <= 1);
    }
}
