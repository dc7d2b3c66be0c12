#pragma once
// Do samples have the density that is said of them? Pearson's chi-square test of counts in cells
// against the density's integrals over these cells, as the tests of PBRT and Mitsuba have it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

#include "core/math/random.h"
#include "core/math/vec3.h"

namespace lightwalk::test {

/// Q(a, x), the regularised upper incomplete gamma function, within 1e-14. Source: Abramowitz &
/// Stegun, "Handbook of Mathematical Functions", 6.5.29 (series) and 6.5.31 (continued fraction,
/// evaluated as Lentz does).
[[nodiscard]] inline double gamma_q(double a, double x) {
    constexpr double kSmall = 1e-16, kTiny = 1e-300;
    if (!(x > 0)) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; term > kSmall * sum; ++n) sum += term *= x / (a + n);
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
    for (int n = 1; n < 100000; ++n) {
        const double k = -n * (n - a);
        b += 2;
        d = k * d + b;
        d = 1 / (std::abs(d) < kTiny ? kTiny : d);
        c = b + k / c;
        if (std::abs(c) < kTiny) c = kTiny;
        const double factor = d * c;
        h *= factor;
        if (std::abs(factor - 1) < kSmall * 10) break;
    }
    return front * h;
}

/// The outcome of a test.
struct ChiSquare {
    double statistic = 0;
    int freedom = 0;  ///< degrees of freedom: cells after pooling, less one
    double p = 1;     ///< probability of a statistic at least as large when the density is true

    friend std::ostream& operator<<(std::ostream& out, const ChiSquare& c) {
        return out << "chi-square " << c.statistic << " of " << c.freedom
                   << " degrees of freedom, p = " << c.p;
    }
};

/// The number of chi-square tests in the suite, or rather more.
inline constexpr int kChiSquareTests = 200;
/// The probability that a suite of true densities is refused somewhere, had its seeds not been
/// fixed.
inline constexpr double kSuiteLevel = 0.01;

/// Whether a test does not speak against the density. The level of one test is such that all of
/// the suite together have kSuiteLevel (Sidak, "Rectangular confidence regions for the means of
/// multivariate normal distributions", Journal of the American Statistical Association 62, 1967).
[[nodiscard]] inline bool agrees(const ChiSquare& test) {
    return test.p > 1 - std::pow(1 - kSuiteLevel, 1.0 / kChiSquareTests);
}

/// Samples in cells: how many there are, and how many the density says.
struct CellCounts {
    std::vector<double> observed, expected;
};

/// Pearson's test. Cells that expect fewer than 5 are pooled, least first, until they expect as
/// many. A sample where the density is 0, or an expectation below 0, is refused outright (p = 0).
[[nodiscard]] inline ChiSquare chi_square(const CellCounts& cells) {
    constexpr double kFewest = 5;
    std::vector<std::size_t> order(cells.expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return cells.expected[a] < cells.expected[b]; });
    ChiSquare result;
    double observed = 0, expected = 0;
    int pools = 0;
    const auto close_pool = [&] {
        if (expected > 0) {
            result.statistic += (observed - expected) * (observed - expected) / expected;
            ++pools;
        }
        observed = expected = 0;
    };
    for (const std::size_t i : order) {
        if (cells.expected[i] < 0 || (cells.expected[i] == 0 && cells.observed[i] > 0))
            return {std::numeric_limits<double>::infinity(), 0, 0};
        observed += cells.observed[i];
        expected += cells.expected[i];
        if (expected >= kFewest) close_pool();
    }
    close_pool();  // what is left when all cells together expect fewer
    result.freedom = pools - 1;
    if (result.freedom < 1) return result;
    result.p = gamma_q(0.5 * result.freedom, 0.5 * result.statistic);
    return result;
}

struct UnitSquareCells {
    int rows = 20, columns = 40;  ///< along x and along y
};

/// Integral of f(x, y) over a rectangle, within about `tolerance`: nine Gauss points, or those of
/// its quarters where they say something else.
template <class F>
[[nodiscard]] double integrate(const F& f, double x0, double x1, double y0, double y1,
                               double tolerance, int depth = 9) {
    constexpr double kFar = 0.77459666924148337704;  // sqrt(3/5)
    constexpr std::array<double, 3> kPlace{-kFar, 0, kFar}, kWeight{5. / 18, 8. / 18, 5. / 18};
    const auto gauss = [&](double a0, double a1, double b0, double b1) {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                sum += kWeight[i] * kWeight[j] *
                       f(0.5 * (a0 + a1 + kPlace[i] * (a1 - a0)),
                         0.5 * (b0 + b1 + kPlace[j] * (b1 - b0)));
        return sum * (a1 - a0) * (b1 - b0);
    };
    const double x = 0.5 * (x0 + x1), y = 0.5 * (y0 + y1);
    const double whole = gauss(x0, x1, y0, y1);
    const double quarters =
        gauss(x0, x, y0, y) + gauss(x, x1, y0, y) + gauss(x0, x, y, y1) + gauss(x, x1, y, y1);
    if (depth == 0 || std::abs(quarters - whole) <= tolerance) return quarters;
    const double less = 0.5 * tolerance;
    return integrate(f, x0, x, y0, y, less, depth - 1) +
           integrate(f, x, x1, y0, y, less, depth - 1) +
           integrate(f, x0, x, y, y1, less, depth - 1) +
           integrate(f, x, x1, y, y1, less, depth - 1);
}

/// The density's integral over each cell of the unit square, row by row.
/// @param density  double(x, y)
template <class Density>
[[nodiscard]] std::vector<double> cell_masses(const UnitSquareCells& cells,
                                              const Density& density) {
    constexpr double kTolerance = 3e-8;  // far less than a sample, of 100,000
    std::vector<double> masses;
    for (int i = 0; i < cells.rows; ++i)
        for (int j = 0; j < cells.columns; ++j)
            masses.push_back(integrate(density, double(i) / cells.rows, double(i + 1) / cells.rows,
                                       double(j) / cells.columns, double(j + 1) / cells.columns,
                                       kTolerance));
    return masses;
}

using SquarePoint = std::array<double, 2>;

/// Counts and expectations in cells of the unit square. One more cell at the end: trials that gave
/// nothing, for which there is what the density lacks to 1.
/// @param draw  std::optional<SquarePoint>(RandomStream&)
template <class Draw>
[[nodiscard]] CellCounts count_cells(const UnitSquareCells& cells,
                                     const std::vector<double>& masses, int trials,
                                     std::uint64_t seed, const Draw& draw) {
    constexpr double kQuadrature = 1e-5;  // what the masses may be wrong by together
    CellCounts counts{std::vector<double>(masses.size() + 1), {}};
    RandomStream random(mix_bits(seed));
    for (int k = 0; k < trials; ++k) {
        const std::optional<SquarePoint> at = draw(random);
        std::size_t cell = masses.size();
        if (at) {
            const int i = std::clamp(static_cast<int>((*at)[0] * cells.rows), 0, cells.rows - 1);
            const int j =
                std::clamp(static_cast<int>((*at)[1] * cells.columns), 0, cells.columns - 1);
            cell = static_cast<std::size_t>(i * cells.columns + j);
        }
        ++counts.observed[cell];
    }
    double lack = 1;
    for (const double mass : masses) {
        counts.expected.push_back(mass * trials);
        lack -= mass;
    }
    counts.expected.push_back(std::abs(lack) < kQuadrature ? 0 : lack * trials);
    return counts;
}

/// Cells of all directions: rows of cosines to an axis, columns of azimuths about it.
struct DirectionCells {
    Vec3 axis{0, 0, 1};
    /// 1: rows of equal solid angle; more: narrower the nearer they are to the axis, the border
    /// between rows i and i + 1 of n lies at 1 - cosθ = 2 ((i + 1) / n)^concentration.
    int concentration = 1;
    int rows = 20, columns = 40;

    [[nodiscard]] UnitSquareCells square() const { return {rows, columns}; }
    [[nodiscard]] SquarePoint to_square(const Vec3& direction) const {
        const Vec3 u = perpendicular(axis), v = cross(axis, u);
        const double half_height = 0.25 * length_squared(direction - axis);  // (1 - cosθ) / 2
        const double turn = std::atan2(dot(direction, v), dot(direction, u)) / (2 * kPi);
        return {std::pow(half_height, 1.0 / concentration), turn < 0 ? turn + 1 : turn};
    }
    [[nodiscard]] Vec3 to_direction(double x, double y) const {
        const Vec3 u = perpendicular(axis), v = cross(axis, u);
        const double height = 2 * std::pow(x, concentration);
        const double sine = std::sqrt(std::max(0.0, height * (2 - height)));
        return u * (sine * std::cos(2 * kPi * y)) + v * (sine * std::sin(2 * kPi * y)) +
               axis * (1 - height);
    }
    /// Solid angle over area of the unit square [sr].
    [[nodiscard]] double stretch(double x) const {
        return 4 * kPi * concentration * std::pow(x, concentration - 1);
    }
};

/// Integrals over the cells of a function of direction; of a density over solid angle, the
/// probabilities of the cells.
/// @param pdf  double(const Vec3&) [1/sr]
template <class Pdf>
[[nodiscard]] std::vector<double> cell_masses(const DirectionCells& cells, const Pdf& pdf) {
    return cell_masses(cells.square(), [&](double x, double y) {
        return pdf(cells.to_direction(x, y)) * cells.stretch(x);
    });
}

/// Integral of a function of direction over the sphere.
template <class F>
[[nodiscard]] double sphere_integral(const DirectionCells& cells, const F& f) {
    const std::vector<double> masses = cell_masses(cells, f);
    return std::accumulate(masses.begin(), masses.end(), 0.0);
}

/// Counts and expectations of sampled directions.
/// @param sample  std::optional<Vec3>(RandomStream&): a unit direction, or nothing
/// @param pdf     double(const Vec3&) [1/sr]; what it lacks to 1 is the probability of nothing
template <class Sample, class Pdf>
[[nodiscard]] CellCounts count_directions(const DirectionCells& cells, int trials,
                                          std::uint64_t seed, const Sample& sample,
                                          const Pdf& pdf) {
    return count_cells(cells.square(), cell_masses(cells, pdf), trials, seed,
                       [&](RandomStream& random) -> std::optional<SquarePoint> {
                           const std::optional<Vec3> direction = sample(random);
                           if (!direction) return std::nullopt;
                           return cells.to_square(*direction);
                       });
}

/// The test of sampled directions against their density.
template <class Sample, class Pdf>
[[nodiscard]] ChiSquare test_directions(const DirectionCells& cells, int trials, std::uint64_t seed,
                                        const Sample& sample, const Pdf& pdf) {
    return chi_square(count_directions(cells, trials, seed, sample, pdf));
}

}  // namespace lightwalk::test
