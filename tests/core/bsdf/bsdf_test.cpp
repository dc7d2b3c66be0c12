#include "core/bsdf/bsdf.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "core/bsdf/disk_square.h"
#include "core/bsdf/through_part.h"
#include "core/math/random.h"
#include "tests/core/chi_square.h"

using namespace lightwalk;

namespace {

/// BSDF value of light that travels along `in` (projected) and leaves along `out`.
using Scatter = std::function<double(ProjectedDirection in, ProjectedDirection out)>;

double lobe(ProjectedDirection in, ProjectedDirection out) {
    const double x = out.x - in.x - 0.2, y = out.y - in.y - 0.1;
    return 0.6 * std::exp(-(x * x + y * y) / 0.15);
}

BsdfMatrix matrix_of(const Scatter& f, const char* basis = "LBNL/Klems Quarter") {
    BsdfMatrix matrix{*klems_basis(basis), *klems_basis(basis), {}, {}};
    for (std::size_t i = 0; i < matrix.incident.size(); ++i) {
        for (std::size_t o = 0; o < matrix.exitant.size(); ++o) {
            matrix.y.push_back(static_cast<float>(
                f(matrix.incident.sample(i, 0.5, 0.5), matrix.exitant.sample(o, 0.5, 0.5))));
        }
    }
    return matrix;
}

BsdfTree tree_of(const Scatter& f, int levels) {
    const std::size_t side = std::size_t{1} << levels;
    std::vector<float> values;
    for (std::size_t k = 0; k < side * side * side * side; ++k) {
        const auto coordinate = [&](int d) {
            return (static_cast<double>(k >> (levels * (3 - d)) & (side - 1)) + 0.5) /
                   static_cast<double>(side);
        };
        values.push_back(static_cast<float>(f(square_to_disk({coordinate(0), coordinate(1)}),
                                              square_to_disk({coordinate(2), coordinate(3)}))));
    }
    BsdfTree tree{TensorTree(4), {}, {}};
    tree.y.set_root(tree.y.add_grid(values, levels));
    return tree;
}

/// The same in all azimuths.
BsdfTree isotropic_tree() {
    std::vector<float> values;
    for (std::size_t k = 0; k < 4096; ++k) {
        const double sine = 1 - 2 * ((static_cast<double>(k / 256) + 0.5) / 16);
        const ProjectedDirection out =
            square_to_disk({(static_cast<double>(k / 16 % 16) + 0.5) / 16,
                            (static_cast<double>(k % 16) + 0.5) / 16});
        values.push_back(sine > 0 ? static_cast<float>(lobe({sine, 0}, out)) : 0.0f);
    }
    BsdfTree tree{TensorTree(3), {}, {}};
    tree.y.set_root(tree.y.add_grid(values, 4));
    return tree;
}

Bsdf bsdf_of(BsdfPart part, BsdfTable table) {
    auto data = std::make_shared<BsdfData>();
    data->name = "test";
    data->parts[static_cast<std::size_t>(part)] = std::move(table);
    return Bsdf(data);
}

const ProjectedDirection kDirections[] = {{0.01, 0.02}, {0.5, -0.2}, {-0.3, 0.7}, {-0.8, -0.4}};

/// The integral of f over the hemisphere, by points that are uniform in projected solid angle.
double integral(const BsdfLobes& lobes, ProjectedDirection e) {
    double sum = 0;
    constexpr int kSide = 512;
    for (int i = 0; i < kSide; ++i) {
        for (int k = 0; k < kSide; ++k) {
            const ProjectedDirection l = square_to_disk({(i + 0.5) / kSide, (k + 0.5) / kSide});
            sum += static_cast<double>(brightness(lobes.value_for(lobes.look_up(e), l).f));
        }
    }
    return sum * kPi / (kSide * kSide);
}

/// Checks that samples fall on the hemisphere in proportion to the values.
void check_samples(const BsdfLobes& lobes, ProjectedDirection e) {
    constexpr int kCells = 8, kPoints = 64, kSamples = 50000;  // on a side, in a cell's side
    test::CellCounts counts;
    counts.observed.resize(kCells * kCells);
    counts.expected.resize(kCells * kCells);
    const double total = lobes.total(lobes.look_up(e));
    for (int i = 0; i < kCells * kPoints; ++i) {
        for (int k = 0; k < kCells * kPoints; ++k) {
            const ProjectedDirection l =
                square_to_disk({(i + 0.5) / (kCells * kPoints), (k + 0.5) / (kCells * kPoints)});
            counts.expected[static_cast<std::size_t>(i / kPoints * kCells + k / kPoints)] +=
                static_cast<double>(brightness(lobes.value_for(lobes.look_up(e), l).f));
        }
    }
    double sum = 0;
    for (const double expected : counts.expected) sum += expected;
    CHECK(sum * kPi / (kCells * kCells * kPoints * kPoints) ==
          doctest::Approx(total).epsilon(0.01));
    for (double& expected : counts.expected) expected *= kSamples / sum;
    RandomStream random(3);
    for (int i = 0; i < kSamples; ++i) {
        const double choice = random.next(), xi1 = random.next(), xi2 = random.next();
        const UnitSquarePoint at =
            disk_to_square(lobes.sample(lobes.look_up(e), choice, xi1, xi2).l);
        const auto cell = [](double x) {
            return std::clamp(static_cast<int>(x * kCells), 0, kCells - 1);
        };
        ++counts.observed[static_cast<std::size_t>(cell(at.x) * kCells + cell(at.y))];
    }
    CHECK(test::agrees(test::chi_square(counts)));
}

}  // namespace

TEST_CASE("BSDF: values of several directions about the viewer's are those of each") {
    for (const BsdfTable& table : {BsdfTable(matrix_of(lobe)), BsdfTable(tree_of(lobe, 3))}) {
        const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, table);
        for (const bool front : {true, false}) {  // in reverse from behind
            const BsdfLobes& lobes = *bsdf.transmission(front).lobes;
            for (const ProjectedDirection& l : kDirections) {
                const BsdfLookup light = lobes.look_up_light(l);
                NearDirections near;
                for (std::size_t i = 0; i < kNearDirections; ++i) {
                    near.x[i] = kDirections[i].x;
                    near.y[i] = kDirections[i].y;
                }
                const auto values = lobes.values_near(near, light);
                for (std::size_t i = 0; i < kNearDirections; ++i) {
                    const BsdfLobes::Value one = lobes.value(lobes.look_up(kDirections[i]), light);
                    CHECK(values[i].f == one.f);
                    CHECK(values[i].solid_angle == one.solid_angle);
                    CHECK(values[i].cell == one.cell);
                    CHECK(values[i].has_lobe == one.has_lobe);
                }
            }
        }
    }
}

TEST_CASE("BSDF lobes: the total is the integral of the values") {
    const Bsdf bsdfs[] = {bsdf_of(BsdfPart::front_transmission, matrix_of(lobe)),
                          bsdf_of(BsdfPart::front_transmission, tree_of(lobe, 3)),
                          bsdf_of(BsdfPart::front_transmission, isotropic_tree())};
    for (const Bsdf& bsdf : bsdfs) {
        for (const ProjectedDirection& e : kDirections) {
            const BsdfLobes& lobes = *bsdf.transmission(true).lobes;
            CHECK(lobes.total(lobes.look_up(e)) ==
                  doctest::Approx(integral(lobes, e)).epsilon(0.01));
        }
    }
}

TEST_CASE("BSDF lobes: samples have the density of the values") {
    const Bsdf bsdfs[] = {bsdf_of(BsdfPart::front_transmission, matrix_of(lobe)),
                          bsdf_of(BsdfPart::front_transmission, tree_of(lobe, 4)),
                          bsdf_of(BsdfPart::front_transmission, tree_of(lobe, 1)),
                          bsdf_of(BsdfPart::front_transmission, isotropic_tree())};
    for (const Bsdf& bsdf : bsdfs) {
        for (const ProjectedDirection& e : kDirections)
            check_samples(*bsdf.transmission(true).lobes, e);
    }
}

TEST_CASE("BSDF: transmission from one side alone is reciprocal, values and totals") {
    for (const BsdfTable& table : {BsdfTable(matrix_of(lobe)), BsdfTable(tree_of(lobe, 3))}) {
        const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, table);
        const BsdfLobes &front = *bsdf.transmission(true).lobes,
                        &back = *bsdf.transmission(false).lobes;
        for (const ProjectedDirection& e : kDirections) {
            for (const ProjectedDirection& l : kDirections)
                CHECK(front.value_for(front.look_up(e), l).f ==
                      back.value_for(back.look_up(l), e).f);
            CHECK(back.total(back.look_up(e)) == doctest::Approx(integral(back, e)).epsilon(0.01));
            check_samples(back, e);
        }
    }
}

TEST_CASE("BSDF: of a tree of rank 3 there are values in reverse, but no totals") {
    const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, isotropic_tree());
    const BsdfLobes &front = *bsdf.transmission(true).lobes,
                    &back = *bsdf.transmission(false).lobes;
    CHECK(front.value_for(front.look_up({0.3, 0.1}), {-0.2, 0.1}).f ==
          back.value_for(back.look_up({-0.2, 0.1}), {0.3, 0.1}).f);
    CHECK(back.total(back.look_up({0.3, 0.1})) == 0);
}

TEST_CASE("BSDF: a tree of rank 3 looks alike after a turn about its normal") {
    const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, isotropic_tree());
    const BsdfLobes& lobes = *bsdf.transmission(true).lobes;
    const double c = std::cos(1.1), s = std::sin(1.1);
    const auto turn = [&](ProjectedDirection p) {
        return ProjectedDirection{c * p.x - s * p.y, s * p.x + c * p.y};
    };
    for (const ProjectedDirection& e : kDirections) {
        for (const ProjectedDirection& l : kDirections)
            CHECK(lobes.value_for(lobes.look_up(e), l).f ==
                  lobes.value_for(lobes.look_up(turn(e)), turn(l)).f);
    }
}

TEST_CASE("BSDF: what is the same in all directions is Lambertian, the rest are lobes") {
    const auto shifted = [](ProjectedDirection in, ProjectedDirection out) {
        return 0.1 + lobe(in, out);
    };
    for (const BsdfTable& table : {BsdfTable(matrix_of(shifted)), BsdfTable(tree_of(shifted, 3))}) {
        const Bsdf bsdf = bsdf_of(BsdfPart::front_reflection, table);
        const BsdfComponent& part = bsdf.reflection(true);
        CHECK(part.lambertian.g == doctest::Approx(0.1 * kPi).epsilon(1e-3));
        REQUIRE(part.lobes);
        const ProjectedDirection e{0.4, 0.1};
        CHECK(static_cast<double>(brightness(part.value(e, {-0.4, -0.1}))) > 0.1);
        CHECK(part.lobes->total(part.lobes->look_up(e)) ==
              doctest::Approx(integral(*part.lobes, e)).epsilon(0.01));
    }
    const Bsdf flat =
        bsdf_of(BsdfPart::front_reflection, matrix_of([](auto, auto) { return 0.2; }));
    CHECK_FALSE(flat.reflection(true).lobes);
    CHECK(flat.reflection(true).lambertian.r == doctest::Approx(0.2 * kPi).epsilon(1e-5));
    CHECK_FALSE(flat.reflection(false).lobes);
    CHECK(flat.reflection(false).lambertian == Rgb{});
}

TEST_CASE("BSDF: colours of a matrix and of trees are split without loss") {
    BsdfMatrix matrix = matrix_of([](auto in, auto out) { return 0.05 + lobe(in, out); });
    matrix.xz.assign(matrix.y.size(), {1.3f, 0.4f});
    BsdfTree tree = tree_of([](auto in, auto out) { return 0.05 + lobe(in, out); }, 3);
    tree.u = TensorTree(4, 0.25f);
    tree.v = TensorTree(4, 0.5f);
    for (const BsdfTable& table : {BsdfTable(matrix), BsdfTable(tree)}) {
        const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, table);
        const BsdfComponent& part = bsdf.transmission(true);
        const Rgb value = part.value({0.1, 0.2}, {0.15, 0});
        const Rgb tint = value * (1 / brightness(value)),
                  constant = part.lambertian * (1 / brightness(part.lambertian));
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(tint[c] == doctest::Approx(constant[c]).epsilon(1e-3));
        CHECK(tint.r > 1.2f);
        CHECK(tint.b < 0.8f);
        const BsdfLobes::Sample sample =
            part.lobes->sample(part.lobes->look_up({0.1, 0.2}), 0.4, 0.5, 0.5);
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(sample.color[c] == doctest::Approx(tint[c]).epsilon(1e-3));
    }
}

TEST_CASE("BSDF: a total above 1 is told") {
    const Bsdf bsdf =
        bsdf_of(BsdfPart::front_transmission, matrix_of([](auto, auto) { return 0.4; }));
    REQUIRE(bsdf.warnings().size() == 2);  // and in reverse
    CHECK(bsdf.warnings()[0].find("BSDF \"test\" has 125.7% front transmission") == 0);
}

TEST_CASE("BSDF: what is made of a tree of 16^4 leaves takes less than the leaves") {
    const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, tree_of(lobe, 4));
    CHECK(bsdf.own_bytes() < std::size_t{65536} * sizeof(float) * 2);
}

TEST_CASE("BSDF: sums over a tree take time in proportion to its nodes, however uneven they are") {
    // Over a corner of the incident square there are 65536 exitant leaves, and over one of these
    // 16384 incident cells: leaf by leaf the slices would take a billion steps.
    BsdfTree table{TensorTree(4), {}, {}};
    const auto divide = [&](const std::function<TensorTree::Entry(std::size_t)>& child) {
        std::array<TensorTree::Entry, 16> children{};
        for (std::size_t c = 0; c < 16; ++c) children[c] = child(c);
        return table.y.add(children);
    };
    const auto leaf = [](float value) { return TensorTree::leaf(value); };
    const std::function<TensorTree::Entry(int, float)> incident = [&](int levels, float value) {
        return divide([&](std::size_t c) {
            return c >> 2 == 0 && levels > 1 ? incident(levels - 1, value) : leaf(value);
        });
    };
    const std::function<TensorTree::Entry(int, bool, float)> exitant = [&](int levels, bool corner,
                                                                           float value) {
        return divide([&](std::size_t c) {
            // Half of the exitant square is dark.
            const float below = levels < 8 ? value : (c >> 2 & 1U) == 0 ? 0.2f : 0.0f;
            if ((c & 3U) != 0) return leaf(below);
            const bool in_corner = corner && c == 0;
            if (levels > 1) return exitant(levels - 1, in_corner, below);
            return in_corner ? incident(7, below) : leaf(below);
        });
    };
    table.y.set_root(exitant(8, true, 0));
    REQUIRE(table.y.sound());
    const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, table);
    const BsdfLobes& lobes = *bsdf.transmission(true).lobes;
    std::vector<ProjectedDirection> directions(std::begin(kDirections), std::end(kDirections));
    for (const double x : {0x1p-16, 0x1p-12, 0x1p-7}) {
        const ProjectedDirection travel = square_to_disk({x, 0.7 * x});
        directions.push_back({-travel.x, -travel.y});
    }
    for (const ProjectedDirection& e : directions)
        CHECK(lobes.total(lobes.look_up(e)) == doctest::Approx(0.1 * kPi).epsilon(1e-5));
}

TEST_CASE("through part: a peak over a constant passes straight, a smooth lobe does not") {
    const AngleBasis full = *klems_basis("LBNL/Klems Full");
    BsdfMatrix peak{full, full, std::vector<float>(full.size() * full.size(), 0.05f), {}};
    for (std::size_t i = 0; i < full.size(); ++i)
        peak.y[i * full.size() + i] += static_cast<float>(0.5 / full.solid_angle(i));
    const Bsdf bsdf = bsdf_of(BsdfPart::front_transmission, peak);
    for (const ProjectedDirection& e : kDirections) {
        const ThroughPart through = find_through_part(bsdf.transmission(true), e);
        if (!through.exists()) continue;  // patches near the horizon are larger than a peak may be
        CHECK(through.transmittance.g == doctest::Approx(0.5).epsilon(1e-3));
        CHECK(through.surround.g == doctest::Approx(0).epsilon(1e-4));
    }
    CHECK(find_through_part(bsdf.transmission(true), ProjectedDirection{0.01, 0}).exists());
    CHECK(find_through_part(bsdf.transmission(false), ProjectedDirection{0.01, 0}).exists());
    const Bsdf smooth = bsdf_of(BsdfPart::front_transmission, matrix_of(lobe, "LBNL/Klems Full"));
    CHECK_FALSE(find_through_part(smooth.transmission(true), ProjectedDirection{0.01, 0}).exists());
    CHECK_FALSE(find_through_part({}, ProjectedDirection{0, 0}).exists());
}
