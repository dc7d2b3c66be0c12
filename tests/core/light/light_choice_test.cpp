// A few of many stand for all.
#include "core/light/light_choice.h"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "core/math/random.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

std::vector<float> random_sizes(std::size_t count, std::uint64_t seed) {
    RandomStream random(seed);
    std::vector<float> sizes;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = random.next();
        sizes.push_back(random.next() < 0.2 ? 0.0f : static_cast<float>(x * x * x * 10));
    }
    return sizes;
}

std::size_t positive(const std::vector<float>& sizes) {
    std::size_t count = 0;
    for (const float size : sizes) count += size > 0 ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("chosen lights: each brings in the mean what it brings where all are taken") {
    constexpr int kTries = 20000;
    for (const std::size_t count : {std::size_t{3}, std::size_t{9}, std::size_t{40}}) {
        for (const std::size_t wanted : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
            CAPTURE(count);
            CAPTURE(wanted);
            const std::vector<float> sizes = random_sizes(count, count * 10 + wanted);
            std::vector<double> mean(count);
            std::vector<LightChoice> chosen;
            for (int i = 0; i < kTries; ++i) {
                choose_lights(sizes, wanted, (i + 0.5) / kTries, chosen);
                for (const LightChoice& c : chosen)
                    mean[c.which] += static_cast<double>(c.scale) / kTries;
            }
            for (std::size_t k = 0; k < count; ++k) {
                // The numbers go through all of [0, 1) in even steps: a share is off by a step at
                // either end, times its scale of at most 1000.
                if (sizes[k] > 0)
                    CHECK(mean[k] == within(2 * 1000.0 / kTries, 1.0));
                else
                    CHECK(mean[k] == 0);
            }
        }
    }
}

TEST_CASE("chosen lights: about as many as are wanted, in order, and together what all bring") {
    std::vector<LightChoice> chosen;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const std::vector<float> sizes = random_sizes(30, seed);
        double all = 0;
        for (const float size : sizes) all += static_cast<double>(size);
        RandomStream random(~seed);
        choose_lights(sizes, 4, random.next(), chosen);
        CHECK(chosen.size() >= 3);
        CHECK(chosen.size() <= 5);
        double sum = 0;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (i > 0) CHECK(chosen[i].which > chosen[i - 1].which);
            CHECK(chosen[i].scale >= 1);
            CHECK(chosen[i].scale <= 1001);
            sum += static_cast<double>(chosen[i].scale * sizes[chosen[i].which]);
        }
        // One choice more or less, where rare ones are taken more often than their size tells.
        CHECK(sum == within(0.27 * all, all));
    }
}

TEST_CASE(
    "chosen lights: the large ones always, and all where they are few or cannot be measured") {
    std::vector<LightChoice> chosen;
    const std::vector<float> mixed{1, 50, 1, 1, 40, 1, 1};
    for (int i = 0; i < 10; ++i) {
        choose_lights(mixed, 3, i / 10.0, chosen);
        REQUIRE(chosen.size() == 3);
        for (const LightChoice& c : chosen)
            CHECK(c.scale == rounded(c.which == 1 || c.which == 4 ? 1.0 : 5.0));
    }
    const float infinite = std::numeric_limits<float>::infinity();
    for (const std::vector<float>& sizes : {std::vector<float>{0, 2, 0, 3},
                                            {7},
                                            {5, 5},
                                            {1, infinite, 1, 2},
                                            {infinite - infinite, 1}}) {
        for (const double random : {0.0, 0.5, 0.999}) {
            choose_lights(sizes, 2, random, chosen);
            const bool measurable = sizes.size() < 4 || sizes[1] < infinite;
            CHECK(chosen.size() == (measurable && sizes[0] >= 0 ? positive(sizes) : sizes.size()));
            for (const LightChoice& c : chosen) CHECK(c.scale == 1);
        }
    }
    choose_lights(std::vector<float>{0, 0}, 2, 0.5, chosen);
    CHECK(chosen.empty());
}
