// The noise functions: reference values, and the laws that gradient noise obeys.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/function/noise.h"
#include "tests/core/function/evaluate.h"

namespace lightwalk::test {
namespace {

struct NoiseRow {
    std::array<double, 3> p;
    std::array<double, 5> values;  ///< noise3, noise3x, noise3y, noise3z, fnoise3
};
const std::vector<NoiseRow> kNoise{
    {{0, 0, 0},
     {0.0, 1.000002495628136, 2.4968773092437506e-06, 0.9999999987508267, -0.2823797350104106}},
    {{0.5, 0.5, 0.5}, {-0.25, -0.6879681246877434, 0.24953125031246248, 0.0, -0.34125511550242593}},
    {{0.1, 0.2, 0.3},
     {0.35122924878110723, 0.28369232754688056, -0.8274128437405492, 0.8548567564038434,
      -0.3803307459296069}},
    {{1.3, 2.2, 3.7},
     {-0.0694162236051458, -0.6956767381483542, -0.23555688107165795, -0.41527372296149,
      -0.5366061776294453}},
    {{-1.3, 2.2, -3.7},
     {0.24676756309427197, 0.5839192804428239, 0.5903965478927797, -0.07431775376098848,
      0.10085640584696784}},
    {{-0.25, -0.5, -0.75},
     {-0.5119762420654297, 1.3563223015482517, -0.7320986626182524, -0.32856316263973895,
      0.11390868520655065}},
    {{3, 4.5, 5},
     {0.5, 3.1220300789058797e-06, 0.0018749987500399357, 1.2496872425771244e-06,
      -0.7981665432015626}},
    {{-1, 0.3, 0.7},
     {-0.26472449136, -0.9734059381274474, -0.2611036199637873, -0.14297376069249967,
      -0.5984537023050878}},
    {{7.9, -6.1, 12.345},
     {-0.0032593963468809384, -0.5962791616933105, 0.6911166030416238, -0.02801862929801245,
      -0.5994453280763752}},
    {{100.25, -57.125, 3},
     {0.3803981840610504, 1.0403695473011343, -0.33686232644625225, -0.01605029082174525,
      -0.2815434790503235}},
    {{255.5, 256.5, -0.5},
     {-0.125, -1.1576553115353883, 1.407186561842022, -0.4687496875001307, -0.4505334071297832}},
    {{1234.567, -890.12, 0.001},
     {-0.17431456092373807, 1.113454722900642, -0.46703689680094307, -0.609815345365583,
      -0.08028981082613415}},
    {{10000.37, 2.5, -999.9},
     {-0.4424475365648943, 0.33810959657887274, -0.9734472601903299, -0.015092383662040909,
      0.07020584795752167}},
    {{-29.9999, 17.0001, 8.5},
     {-9.997500209999078e-12, -1.0000006637654475, 0.9999996844793672, 1.872842793911384e-11,
      0.6273223660917028}},
    {{0.999, 0.001, 0.5},
     {-0.500999985002521, 0.9999525307586854, 8.753414881823574e-06, -0.0018749986563371124,
      0.5580290249322951}},
    {{-100.75, -200.25, -300.5},
     {-0.38006019592285156, 0.36646017985897394, -0.5109447480294849, 0.2624355394302835,
      -0.300432545220648}},
};

const std::vector<std::array<double, 2>> kRand{
    {0, 0.954473516496364},           {0.5, 0.2343470132254879},        {1, 0.35008305980591103},
    {2, 0.732379808119731},           {3, 0.3183591835113475},          {10, 0.8349688585149124},
    {0.1, 0.5151936051406665},        {-1, 0.47191853521508165},        {-2.5, 0.22564915163820842},
    {-0.001, 0.8053696666102041},     {123.456, 0.658230833694688},     {1000, 0.09481823518581223},
    {1000000.0, 0.31236551299662096}, {-98765.4321, 0.7087096341856522}};

double slope(int axis, const std::array<double, 3>& p) {
    function::NoiseMemory memory;
    return function::noise3_difference(axis, p[0], p[1], p[2], memory);
}

/// Points that jump about and dwell.
std::vector<std::array<double, 3>> walk() {
    std::vector<std::array<double, 3>> points;
    for (int i = 0; i < 2000; ++i) {
        const double step = i % 7 == 0 ? 3.7 : i % 3 == 0 ? .02 : .0004;
        const std::array<double, 3> last = points.empty() ? std::array<double, 3>{} : points.back();
        points.push_back({last[0] + step * std::sin(i), last[1] + step * std::cos(2.1 * i),
                          last[2] - step * std::sin(.3 * i)});
    }
    return points;
}

/// Of a lattice point of fnoise3, from its coordinates [units of a two-thousandth].
double lattice_value(const std::array<std::int64_t, 3>& at) {
    auto n = static_cast<std::uint32_t>(17 * at[0] + 23 * at[1] + 29 * at[2]);
    n = (n << 13) ^ n;
    return 1 - ((n * (n * n * 15731 + 789221) + 1376312589) & 0x7fffffff) / 1073741824.0;
}

/// Of the 27 points of a cube of eight, place (0, 1 or 2 along each axis): a corner's value, or the
/// mean of the corners around it, displaced.
double between(const std::array<double, 8>& corners, const std::array<int, 3>& place,
               const std::array<std::int64_t, 3>& at, double displacement) {
    double sum = 0, count = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        bool around = true;
        for (unsigned a = 0; a < 3; ++a) {
            around =
                around && (place[a] == 1 || place[a] == static_cast<int>(corner >> a & 1u) * 2);
        }
        sum += around ? corners[corner] : 0;
        count += around ? 1 : 0;
    }
    return sum / count + (count > 1 ? displacement * lattice_value(at) : 0);
}

/// fnoise3 one lattice point at a time: fractal midpoint displacement as the definition has it.
double fractal_by_definition(const std::array<double, 3>& p) {
    std::array<std::int64_t, 3> low{};
    std::array<std::int64_t, 3> target{};
    for (std::size_t a = 0; a < 3; ++a) {
        low[a] = 2000 * static_cast<std::int64_t>(std::floor(p[a]));
        target[a] = static_cast<std::int64_t>(2000 * p[a]);
    }
    std::array<double, 8> corners{};
    for (unsigned c = 0; c < 8; ++c) {
        corners[c] = lattice_value({low[0] + 2000 * (c & 1u), low[1] + 2000 * (c >> 1 & 1u),
                                    low[2] + 2000 * (c >> 2 & 1u)});
    }
    for (std::int64_t half = 1000, level = 0; level < 10; half /= 2, ++level) {
        std::array<int, 3> upper{};
        for (std::size_t a = 0; a < 3; ++a) upper[a] = target[a] - low[a] > half ? 1 : 0;
        std::array<double, 8> next{};
        for (unsigned c = 0; c < 8; ++c) {
            std::array<int, 3> place{};
            std::array<std::int64_t, 3> at{};
            for (unsigned a = 0; a < 3; ++a) {
                place[a] = upper[a] + static_cast<int>(c >> a & 1u);
                at[a] = low[a] + place[a] * half;
            }
            next[c] = between(corners, place, at, static_cast<double>(half) * .0005);
        }
        corners = next;
        for (std::size_t a = 0; a < 3; ++a) low[a] += upper[a] * half;
    }
    double sum = 0;
    for (const double value : corners) sum += value;
    return sum / 8;
}

}  // namespace

TEST_CASE("noise has the values that Radiance prints") {
    for (const NoiseRow& row : kNoise) {
        CAPTURE(row.p);
        const double x = row.p[0], y = row.p[1], z = row.p[2];
        CHECK(std::abs(noise3(x, y, z) - row.values[0]) <= 1e-15);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(std::abs(slope(axis, row.p) - row.values[static_cast<std::size_t>(axis) + 1]) <=
                  4e-12);
        }
        CHECK(fnoise3(x, y, z) == row.values[4]);
    }
}

TEST_CASE("fractal noise is midpoint displacement, whatever vectors the compiler makes of it") {
    for (const auto& p : walk()) {
        CAPTURE(p);
        // Sums of ten levels, in another order.
        CHECK(std::abs(fnoise3(p[0], p[1], p[2]) - fractal_by_definition(p)) < 1e-14);
    }
}

TEST_CASE("rand has the values that Radiance prints") {
    for (const auto& row : kRand) {
        const double x = row[0], value = row[1];
        CAPTURE(x);
        ChannelValues channels{};
        set(channels, Channel::Px, x);
        CHECK(std::abs(evaluate("rand(Px)", {"", {}, 0, channels}).value - value) <= 1e-9);
    }
}

TEST_CASE("gradient noise vanishes on the lattice, repeats after 256, and stays within bounds") {
    double largest = 0;
    for (const auto& p : walk()) {
        CHECK(noise3(std::floor(p[0]), std::floor(p[1]), std::floor(p[2])) == 0);
        const double value = noise3(p[0], p[1], p[2]);
        largest = std::max(largest, std::abs(value));
        CHECK(noise3(p[0] + 256, p[1], p[2] - 512) == doctest::Approx(value).epsilon(1e-9));
    }
    CHECK(largest > .5);
    CHECK(largest <= 1.04);
}

TEST_CASE("noise is continuous across the faces of cells") {
    for (const double n : {-3.0, -1.0, 0.0, 1.0, 255.0, 256.0}) {
        CAPTURE(n);
        CHECK(std::abs(noise3(n - 1e-9, .3, .7) - noise3(n + 1e-9, .3, .7)) < 1e-8);
        CHECK(std::abs(noise3(.3, n - 1e-9, .7) - noise3(.3, n + 1e-9, .7)) < 1e-8);
        CHECK(std::abs(noise3(.3, .7, n - 1e-9) - noise3(.3, .7, n + 1e-9)) < 1e-8);
    }
}

TEST_CASE("noise does not depend on what was asked before") {
    function::NoiseMemory noise;
    function::FractalMemory fractal;
    for (const auto& p : walk()) {
        const double x = p[0], y = p[1], z = p[2];
        CHECK(function::noise3(x, y, z, noise) == noise3(x, y, z));
        CHECK(function::fnoise3(x, y, z, fractal) == fnoise3(x, y, z));
        CHECK(function::noise3_difference(1, x, y, z, noise) == slope(1, p));
    }
}

TEST_CASE("places that noise does not reach have no noise") {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for (const double x : {1e300, -1e18, kInfinite, -kInfinite, std::nan("")}) {
        CHECK(noise3(x, .5, .5) == 0);
        CHECK(fnoise3(.5, x, .5) == 0);
    }
}

}  // namespace lightwalk::test
