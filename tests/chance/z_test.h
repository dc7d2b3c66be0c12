#pragma once
// Have two random pictures the same mean? A z-test for each pixel, and one for all of them
// together. Source: Subr & Arvo, "Statistical hypothesis testing for assessing Monte Carlo
// estimators: applications to image synthesis", Pacific Graphics 2007; as the render tests of
// Mitsuba 3 have it.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <span>
#include <vector>

namespace lightwalk::test {

/// Mean of independent samples, and the variance of this mean.
struct MeanEstimate {
    double mean = 0, variance = 0;
};

/// Sums samples; by differences from the first, so that little is lost where they differ little.
class SampleSums {
  public:
    void add(double x) {
        if (count_ == 0) first_ = x;
        sum_ += x - first_;
        squares_ += (x - first_) * (x - first_);
        ++count_;
    }
    [[nodiscard]] MeanEstimate estimate() const {
        const double n = static_cast<double>(count_), mean = sum_ / n;
        return {first_ + mean, std::max(0.0, squares_ / n - mean * mean) / (n - 1)};
    }

  private:
    double first_ = 0, sum_ = 0, squares_ = 0;
    std::size_t count_ = 0;
};

/// The outcome.
struct ZTest {
    double p = 1;          ///< probability of a pixel at least as far off, or of such a total
    double worst = 0;      ///< |z| of the pixel that is farthest off
    double total = 0;      ///< z of the sum of all pixels
    double precision = 0;  ///< relative standard error of that sum

    friend std::ostream& operator<<(std::ostream& out, const ZTest& t) {
        return out << "worst |z| " << t.worst << ", of the sum " << t.total << " (known to "
                   << 100 * t.precision << " %), p = " << t.p;
    }
};

/// Probability of a standard normal variable at least this far from 0.
inline double two_sided(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

/// Compare a picture with one that is known better, from `more` times as many samples, so that its
/// variances are, too: where few samples have missed a rare event theirs would be too small. p is
/// that of the whole: of n pixels and their sum the least probable one has p1, and p = 1 - (1 -
/// p1)^(n + 1) (Sidak 1967). The correction supposes independent tests; for others it is on the
/// safe side. A pixel without variance must be the same to rounding.
inline ZTest z_test(std::span<const MeanEstimate> a, std::span<const MeanEstimate> b,
                    double more = 1) {
    constexpr double kSame = 1e-5;  // of floats that are summed
    ZTest test;
    double difference = 0, variance = 0, size = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double off = a[i].mean - b[i].mean;
        const double noise = std::max(a[i].variance, more * b[i].variance) + b[i].variance;
        const double rounding = kSame * std::abs(b[i].mean);
        test.worst =
            std::max(test.worst, std::abs(off) / std::sqrt(noise + rounding * rounding + 1e-300));
        difference += off;
        variance += noise + rounding * rounding;
        size += b[i].mean;
    }
    test.total = difference / std::sqrt(variance + 1e-300);
    test.precision = std::sqrt(variance) / size;
    const double least = std::min(two_sided(test.worst), two_sided(test.total));
    test.p =
        -std::expm1(static_cast<double>(a.size() + 1) * std::log1p(-std::min(least, 1 - 1e-16)));
    return test;
}

/// The probability that a right picture is refused, had its seeds not been fixed.
inline constexpr double kPictureLevel = 0.001;
[[nodiscard]] inline bool agrees(const ZTest& test) {
    return test.p > kPictureLevel;
}

}  // namespace lightwalk::test
