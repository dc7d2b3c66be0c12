#include "core/math/corrected_sum.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace lightwalk;

namespace {

/// Terms that are known too dark by a share, and in part not at all; what is true of them.
struct Sum {
    std::vector<KnownTerm> terms;
    std::vector<double> truth;
    double whole = 0;
};

Sum wrong_sum() {
    Sum sum;
    for (int i = 0; i < 400; ++i) {
        const double value = 1 + i % 20 + (i % 50 == 0 ? 300 : 0);
        const double weight = (i % 3 == 0 ? -.2 : 1) / 400;
        sum.terms.push_back({weight, i % 11 == 0 ? 0 : .9 * value});
        sum.truth.push_back(value);
        sum.whole += weight * value;
    }
    return sum;
}

}  // namespace

TEST_CASE("corrected sum: 95 % of the intervals hold the true sum, whatever ails what is known") {
    const Sum sum = wrong_sum();
    constexpr int kTries = 2000;
    int held = 0, half = 0;
    double bias = 0, width = 0, known = 0;
    for (const KnownTerm& term : sum.terms) known += term.weight * term.value;
    for (int i = 0; i < kTries; ++i) {
        RandomStream noise(static_cast<std::uint64_t>(i) + 100000);
        const MeanInterval found =
            corrected_sum(sum.terms, RandomStream(static_cast<std::uint64_t>(i)),
                          [&](std::size_t term) { return sum.truth[term] * (.5 + noise.next()); });
        const double off = found.mean - sum.whole;
        held += std::abs(off) <= found.half_width ? 1 : 0;
        half += std::abs(off) <= found.half_width / 2 ? 1 : 0;
        bias += off / kTries;
        width += found.half_width / kTries;
    }
    CHECK(double(held) / kTries == doctest::Approx(.95).epsilon(.02));
    CHECK(double(half) / kTries < .8);
    CHECK(std::abs(bias) < .1 * width);
    CHECK(std::abs(known - sum.whole) > .5 * width);  // so that the test sees a correction
}

TEST_CASE("corrected sum: where all is right nothing is added, and nothing is uncertain") {
    const Sum sum = wrong_sum();
    const MeanInterval found = corrected_sum(
        sum.terms, RandomStream(1), [&](std::size_t term) { return sum.terms[term].value; });
    double known = 0;
    for (const KnownTerm& term : sum.terms) known += term.weight * term.value;
    CHECK(found.mean == known);
    CHECK(found.half_width == 0);
    CHECK(corrected_sum({}, RandomStream(1), [](std::size_t) { return 1.0; }).mean == 0);
    const std::vector<KnownTerm> weightless(3, {0, 5});
    CHECK(corrected_sum(weightless, RandomStream(1), [](std::size_t) { return 1.0; }).mean == 0);
}

TEST_CASE("corrected sum: light that is known as darkness is found") {
    const std::vector<KnownTerm> dark(10, {.1, 0});
    const MeanInterval found =
        corrected_sum(dark, RandomStream(1), [](std::size_t) { return 7.0; });
    CHECK(found.mean == doctest::Approx(7));
    CHECK(found.half_width < 1e-12);
}
