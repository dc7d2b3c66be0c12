// The chi-square harness itself: it accepts true densities, and finds every error that is planted.
#include "tests/core/chi_square.h"

#include <doctest/doctest.h>

#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kTrials = 100000;

std::optional<Vec3> uniform_direction(RandomStream& random) {
    const double z = 1 - 2 * random.next(), turn = 2 * kPi * random.next();
    const double r = std::sqrt(1 - z * z);
    return Vec3{r * std::cos(turn), r * std::sin(turn), z};
}
double uniform_pdf(const Vec3&) {
    return 1 / (4 * kPi);
}

/// About +z, by the cosine.
std::optional<Vec3> cosine_direction(RandomStream& random) {
    const double r = std::sqrt(random.next()), turn = 2 * kPi * random.next();
    return Vec3{r * std::cos(turn), r * std::sin(turn), std::sqrt(1 - r * r)};
}
double cosine_pdf(const Vec3& wi) {
    return std::max(0.0, wi.z) / kPi;
}

/// Any pair of directions whose roles differ: wi is spread by the cosine about wo.
std::optional<Vec3> about(const Vec3& wo, RandomStream& random) {
    const Vec3 u = perpendicular(wo), v = cross(wo, u), d = *cosine_direction(random);
    return u * d.x + v * d.y + wo * d.z;
}

ChiSquare test_cosine(const DirectionCells& cells, double scale) {
    return test_directions(cells, kTrials, 1, cosine_direction,
                           [scale](const Vec3& wi) { return scale * cosine_pdf(wi); });
}

}  // namespace

TEST_CASE("chi-square: the incomplete gamma function has the values of the printed tables") {
    CHECK(gamma_q(1, 2.5) == rounded(std::exp(-2.5)));
    CHECK(gamma_q(1, 0.3) == rounded(std::exp(-0.3)));
    CHECK(gamma_q(0.5, 1.7) == rounded(std::erfc(std::sqrt(1.7))));
    CHECK(gamma_q(3, 0) == 1);
    // Upper points of the distribution, as printed: freedom, statistic, probability.
    for (const auto& [freedom, statistic, p] : {std::array{10.0, 18.307, 0.05},
                                                {1.0, 3.8415, 0.05},
                                                {100.0, 124.342, 0.05},
                                                {10.0, 29.588, 0.001},
                                                {100.0, 149.449, 0.001},
                                                {100.0, 77.929, 0.95}})
        CHECK(gamma_q(0.5 * freedom, 0.5 * statistic) == within(1e-3, p));  // of the digits given
}

TEST_CASE("chi-square: integrals are refined where nine points a rectangle are too few") {
    const auto peak = [](double x, double y) {
        return std::exp(-((x - 0.3) * (x - 0.3) + (y - 0.6) * (y - 0.6)) / 1e-3);
    };
    CHECK(integrate(peak, 0, 1, 0, 1, 1e-9) == within(1e-5, kPi * 1e-3));
    const auto step = [](double x, double y) { return x + 0.5 * y < 0.7 ? 1 : 0; };
    CHECK(integrate(step, 0, 1, 0, 1, 1e-9) == within(1e-4, 0.45));
}

TEST_CASE("chi-square: cells that expect little are pooled, and impossible counts are refused") {
    // 1 + 2 + 3 are pooled to 6 that were 9 in fact; 10 and 84 stand alone.
    const ChiSquare pooled = chi_square({{12, 2, 79, 3, 4}, {10, 1, 84, 2, 3}});
    CHECK(pooled.freedom == 2);
    CHECK(pooled.statistic == rounded(9. / 6 + 4. / 10 + 25. / 84));
    CHECK(pooled.p == rounded(std::exp(-0.5 * pooled.statistic)));  // of two degrees of freedom
    CHECK(chi_square({{10, 0}, {10, 0}}).p == 1);
    CHECK(chi_square({{100, 1}, {101, 0}}).p == 0);   // a sample where there can be none
    CHECK(chi_square({{100, 0}, {102, -2}}).p == 0);  // a density above 1
    CHECK(!agrees({0, 0, 0}));
}

TEST_CASE("chi-square: cells hold what their borders say, for any axis and concentration") {
    for (const int concentration : {1, 2, 4}) {
        const Vec3 axis = normalize(Vec3{0.3, -0.5, 0.4});
        const DirectionCells cells{axis, concentration, 10, 12};
        CHECK(sphere_integral(cells, [](const Vec3&) { return 1; }) == within(1e-6, 4 * kPi));
        CHECK(sphere_integral(cells, [](const Vec3& d) { return d.x * d.x; }) ==
              within(1e-6, 4 * kPi / 3));
        for (int k = 0; k < 100; ++k) {
            RandomStream random(static_cast<std::uint64_t>(k));
            const double x = 0.01 + 0.98 * random.next(), y = 0.99 * random.next();
            const Vec3 d = cells.to_direction(x, y);
            CHECK(length(d) == rounded(1));
            CHECK(1 - dot(d, axis) == within(1e-9, 2 * std::pow(x, concentration)));
            CHECK(cells.to_square(d)[0] == within(1e-9, x));
            CHECK(cells.to_square(d)[1] == within(1e-9, y));
        }
    }
    // Row by row, the cosine's share is that of squared sines.
    const std::vector<double> masses = cell_masses(DirectionCells{{0, 0, 1}, 1, 8, 3}, cosine_pdf);
    for (std::size_t i = 0; i < 8; ++i) {
        const double top = 1 - 0.25 * static_cast<double>(i);
        const double row = i < 4 ? top * top - (top - 0.25) * (top - 0.25) : 0;
        for (std::size_t j = 0; j < 3; ++j) CHECK(masses[3 * i + j] == within(1e-7, row / 3));
    }
}

TEST_CASE("chi-square: true densities are accepted, and their probabilities are spread evenly") {
    const DirectionCells cells{normalize(Vec3{1, 2, 2}), 1, 8, 8};
    CHECK(agrees(test_directions(cells, kTrials, 1, uniform_direction, uniform_pdf)));
    CHECK(agrees(test_cosine({{0, 0, 1}, 1, 20, 20}, 1)));
    constexpr int kSeeds = 300, kTenths = 10;
    CellCounts tenths{std::vector<double>(kTenths), std::vector<double>(kTenths, kSeeds / kTenths)};
    const std::vector<double> masses = cell_masses(cells, uniform_pdf);
    for (int seed = 0; seed < kSeeds; ++seed) {
        const CellCounts counts =
            count_cells(cells.square(), masses, 1000, static_cast<std::uint64_t>(seed),
                        [&](RandomStream& random) {
                            return std::optional(cells.to_square(*uniform_direction(random)));
                        });
        ++tenths.observed[static_cast<std::size_t>(chi_square(counts).p * 0.9999999 * kTenths)];
    }
    CHECK(agrees(chi_square(tenths)));
}

TEST_CASE("chi-square: planted errors are found") {
    const DirectionCells cells{{0, 0, 1}, 1, 20, 20};
    for (const double scale : {0.98, 1.02}) CHECK(!agrees(test_cosine(cells, scale)));
    // A cosine that is dropped: the density is that of the half sphere.
    CHECK(!agrees(test_directions(cells, kTrials, 1, cosine_direction,
                                  [](const Vec3& wi) { return wi.z > 0 ? 1 / (2 * kPi) : 0; })));
    // One that is taken twice, though it integrates to 1.
    CHECK(!agrees(test_directions(cells, kTrials, 1, cosine_direction, [](const Vec3& wi) {
        return wi.z > 0 ? 1.5 * wi.z * wi.z / kPi : 0;
    })));
    // 2 % of the trials give nothing.
    CHECK(!agrees(test_directions(
        cells, kTrials, 1,
        [](RandomStream& random) {
            return random.next() < 0.02 ? std::nullopt : cosine_direction(random);
        },
        cosine_pdf)));
    // One sample of 100,000 where the density is 0.
    int k = 0;
    CHECK(!agrees(test_directions(
        cells, kTrials, 1,
        [&](RandomStream& random) {
            const std::optional<Vec3> d = cosine_direction(random);
            return ++k == kTrials ? std::optional(-*d) : d;
        },
        cosine_pdf)));
    // What is drawn about wo, said to be drawn about its mirror direction; and about wo turned by
    // two degrees.
    const Vec3 wo = normalize(Vec3{0.5, 0.2, 0.7}), turned = normalize(wo + Vec3{0.04, 0, 0});
    const auto sample = [&](RandomStream& random) { return about(wo, random); };
    const auto pdf_about = [](const Vec3& axis) {
        return [axis](const Vec3& wi) { return std::max(0.0, dot(axis, wi)) / kPi; };
    };
    CHECK(agrees(test_directions({wo}, kTrials, 2, sample, pdf_about(wo))));
    CHECK(!agrees(test_directions({wo}, kTrials, 2, sample, pdf_about({-wo.x, -wo.y, wo.z}))));
    CHECK(!agrees(test_directions({wo}, kTrials, 2, sample, pdf_about(turned))));
}
