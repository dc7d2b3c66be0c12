// Samples of rough lobes have the density that the lobes say: chi-square tests.
#include <doctest/doctest.h>

#include <array>

#include "core/material/lobes.h"
#include "core/material/rough_samples.h"

#include "tests/core/chi_square.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kTrials = 40000;

Vec3 at_angles(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Askew to all axes, so that no component can stand for another one.
LobeFrame askew() {
    const Vec3 n = normalize(Vec3{0.4, -0.3, 0.85}), v = normalize(cross(n, Vec3{0.9, 0.5, 0.1}));
    return {cross(v, n), v, n};
}

Vec3 to_world(const LobeFrame& f, const Vec3& local) {
    return f.u * local.x + f.v * local.y + f.n * local.z;
}

/// Angles of wo to the normal, the last one grazing.
constexpr std::array<double, 4> kAngles{0, 0.6, 1.2, 1.52};

struct Slopes {
    double u, v;
};
constexpr std::array<Slopes, 5> kSlopes{
    {{0.05, 0.05}, {0.2, 0.2}, {0.5, 0.5}, {0.05, 0.3}, {0.4, 0.1}}};

WardReflection ward(double theta, const Slopes& slopes) {
    const LobeFrame frame = askew();
    return {to_world(frame, at_angles(theta, 0.7)), frame, slopes.u, slopes.v};
}
WardTransmission ward_through(double theta, const Slopes& slopes, double bend = 0) {
    const LobeFrame frame = askew();
    const Vec3 wo = to_world(frame, at_angles(theta, 0.7));
    return {normalize(frame.u * bend - wo), dot(wo, frame.n), frame, slopes.u, slopes.v};
}
AshikhminReflection ashikhmin(double theta, double nu, double nv) {
    const LobeFrame frame = askew();
    const Vec3 wo = to_world(frame, at_angles(theta, 0.7));
    return {wo, dot(wo, frame.n), frame, nu, nv};
}

/// A direction around which the lobe lies: the mirror direction, or, where that is grazing, -wo, at
/// which the density of reflections off facets seen edge-on is infinite (though its integral is
/// not).
template <class Lobe>
Vec3 axis_of(const Lobe& lobe) {
    const double cos_o = dot(lobe.wo, lobe.frame.n);
    return cos_o < 0.1 ? -lobe.wo : lobe.frame.n * (2 * cos_o) - lobe.wo;
}
Vec3 axis_of(const WardTransmission& lobe) {
    return lobe.straight;
}

/// A sample to either side: where one is rejected, the other side is asked.
template <class Lobe>
std::optional<Vec3> sample_either(const Lobe& lobe, RandomStream& random) {
    const double xi1 = random.next(), xi2 = random.next();
    const LobeFrame& f = lobe.frame;
    std::optional<Vec3> wi;
    for (const Vec3& ng : {f.n, -f.n, f.u, -f.u})  // the last two where one runs along the surface
        if (!wi) wi = lobe.sample(ng, xi1, xi2);
    return wi;
}

template <class Lobe>
CellCounts count_all(const Lobe& lobe, std::uint64_t seed) {
    return count_directions(
        {axis_of(lobe), 4, 16, 24}, kTrials, seed,
        [&](RandomStream& random) { return sample_either(lobe, random); },
        [&](const Vec3& wi) { return lobe.pdf(wi); });
}

/// The counts agree with the density, and do not agree with one that is 2 % more or less.
void check_counts(const CellCounts& counts) {
    const ChiSquare found = chi_square(counts);
    CAPTURE(found);
    CHECK(agrees(found));
    CHECK(found.freedom > 20);
    for (const double scale : {0.98, 1.02}) {
        CellCounts wrong = counts;
        for (double& expected : wrong.expected) expected *= scale;
        wrong.expected.back() += kTrials * (1 - scale);
        CHECK(!agrees(chi_square(wrong)));
    }
}

/// The same for samples of which those on the wrong side of a surface of normal `ng` are rejected,
/// and are counted.
template <class Lobe>
CellCounts count_accepted(const Lobe& lobe, const Vec3& ng, double side, std::uint64_t seed) {
    return count_directions(
        {ng, 1, 16, 20}, kTrials, seed,
        [&](RandomStream& random) {
            const double xi1 = random.next();
            return lobe.sample(ng, xi1, random.next());
        },
        [&](const Vec3& wi) { return side * dot(wi, ng) > 0 ? lobe.pdf(wi) : 0; });
}

}  // namespace

TEST_CASE("lobes: samples of Ward's reflection have its density, for all slopes and angles") {
    std::uint64_t seed = 100;
    for (const Slopes& slopes : kSlopes)
        for (const double theta : kAngles) {
            CAPTURE(slopes.u);
            CAPTURE(theta);
            check_counts(count_all(ward(theta, slopes), ++seed));
        }
}

TEST_CASE("lobes: samples of Ward's transmission have its density, for all slopes and angles") {
    std::uint64_t seed = 200;
    for (const Slopes& slopes : kSlopes)
        for (const double theta : kAngles) {
            CAPTURE(slopes.u);
            CAPTURE(theta);
            check_counts(count_all(ward_through(theta, slopes), ++seed));
        }
    check_counts(count_all(ward_through(0.6, {0.2, 0.1}, 0.3), ++seed));  // bent by a texture
}

TEST_CASE(
    "lobes: samples of the Ashikhmin-Shirley lobe have its density, for all powers and angles") {
    std::uint64_t seed = 300;
    for (const auto& [nu, nv] : {std::array{3., 7.}, {100., 40.}, {1000., 1000.}, {20., 2000.}})
        for (const double theta : kAngles) {
            CAPTURE(nu);
            CAPTURE(theta);
            check_counts(count_all(ashikhmin(theta, nu, nv), ++seed));
        }
}

TEST_CASE("lobes: Ashikhmin-Shirley half vectors have the published density") {
    const LobeFrame frame = askew();
    const double nu = 25, nv = 90;
    const auto test = [&](double said_nu) {
        return test_directions(
            {frame.n, 3, 16, 24}, kTrials, 350,
            [&](RandomStream& random) {
                const double xi1 = random.next();
                return sample_ashikhmin_half(frame, nu, nv, xi1, random.next());
            },
            [&](const Vec3& h) {
                const double c = dot(h, frame.n), hu = dot(h, frame.u), hv = dot(h, frame.v);
                if (c <= 0) return 0.0;
                const double power = (said_nu * hu * hu + nv * hv * hv) / (1 - c * c);
                return std::sqrt((said_nu + 1) * (nv + 1)) / (2 * kPi) * std::pow(c, power);
            });
    };
    CHECK(agrees(test(nu)));
    CHECK(!agrees(test(1.1 * nu)));
}

TEST_CASE(
    "lobes: what is rejected is the density below the surface, whose normal need not be the "
    "shading normal") {
    std::uint64_t seed = 400;
    for (const double theta : {0.3, 1.3}) {
        CAPTURE(theta);
        const WardReflection ward_lobe = ward(theta, {0.4, 0.25});
        const AshikhminReflection phong = ashikhmin(theta, 8, 15);
        const WardTransmission through = ward_through(theta, {0.4, 0.25});
        const Vec3 n = askew().n, across = ward_lobe.wo - n * through.cos_o;
        for (const Vec3& ng : {n, normalize(n - across * 0.25), normalize(n + across * 0.7)}) {
            CAPTURE(dot(n, ng));
            REQUIRE(dot(ward_lobe.wo, ng) > 0);
            const CellCounts reflected = count_accepted(ward_lobe, ng, 1, ++seed);
            CHECK(agrees(chi_square(reflected)));
            CHECK(agrees(chi_square(count_accepted(phong, ng, 1, ++seed))));
            const CellCounts transmitted = count_accepted(through, ng, -1, ++seed);
            CHECK(agrees(chi_square(transmitted)));
            if (ng == n) CHECK(transmitted.observed.back() == 0);
            if (theta < 1) continue;
            // Rejected reflections off n, where their mirror direction is grazing; transmissions
            // off a surface that wo grazes.
            CHECK((reflected.observed.back() > 0.2 * kTrials) == (dot(across, ng) >= 0));
            CHECK((transmitted.observed.back() > 0.1 * kTrials) == (dot(across, ng) < 0));
        }
    }
}

TEST_CASE("lobes: the chi-square test finds errors of the lobes' own kind") {
    const auto test = [&](const auto& sampled, const auto& pdf) {
        return test_directions(
            DirectionCells{axis_of(sampled), 4, 16, 24}, kTrials, 1,
            [&](RandomStream& random) { return sample_either(sampled, random); }, pdf);
    };
    const WardReflection lobe = ward(0.6, {0.2, 0.3});
    CHECK(agrees(test(lobe, [&](const Vec3& wi) { return lobe.pdf(wi); })));
    // Its value times the cosine, which is the density only where both cosines are the same.
    CHECK(!agrees(test(
        lobe, [&](const Vec3& wi) { return lobe.eval(wi) * std::abs(dot(wi, lobe.frame.n)); })));
    // The slopes of the other axis, or 5 % too wide.
    for (const Slopes& wrong : {Slopes{0.3, 0.2}, Slopes{0.21, 0.3}, Slopes{0.2, 0.315}})
        CHECK(!agrees(test(lobe, [&, w = ward(0.6, wrong)](const Vec3& wi) { return w.pdf(wi); })));
    // wo on the other side of the normal, as where wo and the ray's direction are mixed up.
    const WardReflection turned{-lobe.wo, lobe.frame, 0.2, 0.3};
    CHECK(!agrees(test(lobe, [&](const Vec3& wi) { return turned.pdf(wi); })));
    // wi and wo exchanged: the density of transmission is not symmetric.
    const WardTransmission through = ward_through(1.0, {0.3, 0.3});
    CHECK(agrees(test(through, [&](const Vec3& wi) { return through.pdf(wi); })));
    CHECK(!agrees(test(through, [&](const Vec3& wi) {
        return WardTransmission{wi, 1, through.frame, 0.3, 0.3}.pdf(through.straight);
    })));
    const AshikhminReflection phong = ashikhmin(0.6, 50, 20);
    CHECK(agrees(test(phong, [&](const Vec3& wi) { return phong.pdf(wi); })));
    CHECK(!agrees(test(phong, [&](const Vec3& wi) { return ashikhmin(0.6, 20, 50).pdf(wi); })));
}

TEST_CASE(
    "lobes: -ss below 1 draws from that share of Ward's lobe which is nearest to its centre") {
    constexpr double kShare = 0.6, kAlphaU = 0.2, kAlphaV = 0.35;
    const WardReflection lobe = ward(0.5, {kAlphaU, kAlphaV});
    // The slopes as a point of the unit square, where the density of Ward's facets is 1.
    const auto even = [&](const Vec3& wi) {
        const Vec3 h = lobe.wo + wi;
        const double hn = dot(h, lobe.frame.n), x = dot(h, lobe.frame.u) / (hn * kAlphaU),
                     y = dot(h, lobe.frame.v) / (hn * kAlphaV);
        return SquarePoint{1 - std::exp(-x * x - y * y), std::atan2(y, x) / (2 * kPi) + 0.5};
    };
    const auto test = [&](double share, double said) {
        const UnitSquareCells cells{20, 16};
        const std::vector<double> masses =
            cell_masses(cells, [&](double x, double) { return x < said ? 1 / said : 0; });
        return chi_square(count_cells(cells, masses, kTrials, 7, [&](RandomStream& random) {
            const double xi1 = random.next(), xi2 = narrowed(random.next(), share);
            const std::optional<Vec3> wi = lobe.sample(lobe.frame.n, xi1, xi2);
            return wi ? std::optional(even(*wi)) : std::nullopt;
        }));
    };
    CHECK(agrees(test(kShare, kShare)));
    CHECK(!agrees(test(kShare, 0.65)));
    CHECK(!agrees(test(kShare, 0.55)));
}

TEST_CASE("lobes: value times cosine over density is the weight in closed form") {
    RandomStream random(5);
    int checked = 0;
    for (int i = 0; i < 1000; ++i) {
        const double theta = 1.5 * random.next();
        const WardReflection lobe = ward(theta, {0.1 + random.next(), 0.1 + random.next()});
        const AshikhminReflection phong = ashikhmin(theta, 20 * random.next(), 5);
        const Vec3 wi = to_world(askew(), at_angles(1.5 * random.next(), 6 * random.next()));
        const double cos_i = dot(wi, askew().n);
        if (lobe.pdf(wi) < 1e-100) continue;
        ++checked;
        CHECK(lobe.eval(wi) * cos_i / lobe.pdf(wi) ==
              rounded(WardReflection::weight(dot(lobe.wo, lobe.frame.n), cos_i)));
        CHECK(phong.eval(wi) * cos_i / phong.pdf(wi) ==
              rounded(cos_i / std::max(cos_i, phong.cos_o)));
    }
    CHECK(checked > 900);
}
