// Elementary functions: against the mathematics library, and at their ends.
#include "core/math/elementary.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/math/random.h"

namespace lightwalk {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How many doubles lie between two of the same sign.
std::int64_t steps_between(double a, double b) {
    return std::abs(std::bit_cast<std::int64_t>(a) - std::bit_cast<std::int64_t>(b));
}

/// The largest distance over random numbers between the bounds.
template <class Ours, class Theirs>
std::int64_t worst(Ours ours, Theirs theirs, double low, double high) {
    RandomStream random(1);
    std::int64_t most = 0;
    for (int i = 0; i < 200000; ++i) {
        const double x = low + (high - low) * random.next();
        most = std::max(most, steps_between(ours(x), theirs(x)));
    }
    return most;
}

}  // namespace

TEST_CASE("elementary: the exponential is that of the mathematics library but for the last bit") {
    const auto ours = [](double x) { return elementary::exp(x); };
    const auto theirs = [](double x) { return std::exp(x); };
    CHECK(worst(ours, theirs, -1, 1) <= 1);
    CHECK(worst(ours, theirs, -700, 700) <= 1);
    CHECK(worst(ours, theirs, -744, -700) <= 1);
}

TEST_CASE("elementary: the exponential at its ends") {
    CHECK(elementary::exp(0.0) == 1);
    CHECK(elementary::exp(-0.0) == 1);
    CHECK(elementary::exp(1e-300) == 1);
    CHECK(std::isfinite(elementary::exp(709.78)));
    CHECK(elementary::exp(709.79) == kInfinity);
    CHECK(elementary::exp(kInfinity) == kInfinity);
    CHECK(elementary::exp(-745) > 0);
    CHECK(elementary::exp(-746) == 0);
    CHECK(elementary::exp(-kInfinity) == 0);
    CHECK(std::isnan(elementary::exp(std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("elementary: the arc cosine is that of the mathematics library but for two bits") {
    const auto ours = [](double x) { return elementary::acos(x); };
    const auto theirs = [](double x) { return std::acos(x); };
    CHECK(worst(ours, theirs, -1, 1) <= 2);
    CHECK(worst(ours, theirs, -0.5, 0.5) <= 2);
    CHECK(worst(ours, theirs, 0.999, 1) <= 2);
    CHECK(worst(ours, theirs, -1, -0.999) <= 2);
}

TEST_CASE("elementary: the arc cosine at its ends") {
    CHECK(elementary::acos(1.0) == 0);
    CHECK(elementary::acos(-1.0) == std::acos(-1.0));
    CHECK(elementary::acos(0.0) == std::acos(0.0));
    CHECK(elementary::acos(0.5) == doctest::Approx(std::acos(0.5)).epsilon(1e-15));
    CHECK(std::isnan(elementary::acos(std::nextafter(1.0, 2.0))));
    CHECK(std::isnan(elementary::acos(-1.5)));
    CHECK(std::isnan(elementary::acos(kInfinity)));
    CHECK(std::isnan(elementary::acos(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace lightwalk
