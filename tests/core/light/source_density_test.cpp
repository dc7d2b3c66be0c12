// Samples of light sources have the densities that are said of them: chi-square tests.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "core/light/light_choice.h"
#include "core/light/partition.h"
#include "tests/core/chi_square.h"
#include "tests/core/light/source_examples.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kTrials = 60000;
constexpr double kDiskRadius = 1.12837917;  ///< of a ring, in half axes of the square of its area

LightSource ring(double radius) {
    LightSource source = panel(0.5 * std::sqrt(kPi) * radius);
    source.shape = PrimitiveType::ring;
    return source;
}

LightSource ball(double radius) {
    LightSource source;
    source.center = {0, 0, 1};
    source.u = {kSphereBox * radius, 0, 0};
    source.v = {0, kSphereBox * radius, 0};
    source.w = {0, 0, kSphereBox * radius};
    source.radius = static_cast<float>(radius);
    source.size = static_cast<float>(kPi * radius * radius);
    return source;
}

/// A sun or a part of a sky: `solid_angle` sr about a direction.
LightSource distant(double solid_angle) {
    LightSource source;
    source.shape = PrimitiveType::source;
    source.center = normalize(Vec3{0.3, -0.4, 0.8});
    source.u = perpendicular(source.center) * (0.5 * std::sqrt(solid_angle));
    source.v = cross(source.center, source.u);
    source.size = static_cast<float>(solid_angle);
    return source;
}

/// A lopsided part of a box, and one that is a quadrant.
constexpr SourcePart kPart{{0.5, -0.25, 0}, {0.5, 0.25, 1}};
constexpr SourcePart kQuadrant{{0.5, -0.5, 0}, {0.5, 0.5, 1}};

/// Counts of positions on a flat or distant source, whose half axes' coordinates go from -1 to 1.
CellCounts count_in_square(const LightSource& source, const SourcePart& part, int parts,
                           double jitter, std::uint64_t seed) {
    const UnitSquareCells cells{20, 20};
    const auto masses = cell_masses(cells, [&](double x, double y) {
        return 4 * position_pdf(source, part, parts, jitter, {2 * x - 1, 2 * y - 1, 0});
    });
    return count_cells(cells, masses, kTrials, seed, [&](RandomStream& random) {
        const Vec3 a = position_in_box(source, part, parts, jitter, random);
        return std::optional(SquarePoint{0.5 * (a.x + 1), 0.5 * (a.y + 1)});
    });
}

/// Counts of positions on a round one: cells of equal area on its disk. The density is infinite at
/// the rim, on the diagonals of the square, where cells meet.
CellCounts count_in_disk(const LightSource& source, const SourcePart& part, int parts,
                         double jitter, std::uint64_t seed) {
    const UnitSquareCells cells{10, 48};
    const auto masses = cell_masses(cells, [&](double x, double y) {
        const double r = kDiskRadius * std::sqrt(x), turn = 2 * kPi * y;
        const Vec3 place{r * std::cos(turn), r * std::sin(turn), 0};
        return kPi * kDiskRadius * kDiskRadius * position_pdf(source, part, parts, jitter, place);
    });
    return count_cells(cells, masses, kTrials, seed, [&](RandomStream& random) {
        const Vec3 a = position_in_box(source, part, parts, jitter, random);
        const double turn = std::atan2(a.y, a.x) / (2 * kPi);
        return std::optional(SquarePoint{(a.x * a.x + a.y * a.y) / (kDiskRadius * kDiskRadius),
                                         turn < 0 ? turn + 1 : turn});
    });
}

void check_counts(const CellCounts& counts) {
    const ChiSquare found = chi_square(counts);
    CAPTURE(found);
    CHECK(agrees(found));
    CHECK(found.freedom > 20);
    for (const double scale : {0.97, 1.03}) {
        CellCounts wrong = counts;
        for (double& expected : wrong.expected) expected *= scale;
        wrong.expected.back() += kTrials * (1 - scale);
        CHECK(!agrees(chi_square(wrong)));
    }
}

}  // namespace

TEST_CASE("sources: positions on polygons are uniform in their part, as far as the jitter goes") {
    check_counts(count_in_square(panel(0.5), kWholeBox, 1, 1, 1));
    check_counts(count_in_square(panel(0.5), kWholeBox, 1, 0.6, 2));
    check_counts(count_in_square(panel(0.5), kPart, 8, 0.9, 3));
}

TEST_CASE("sources: positions on rings and in the sky have the density of the squeezed square") {
    for (const LightSource& source : {ring(0.5), distant(0.3)}) {
        check_counts(count_in_disk(source, kWholeBox, 1, 1, 4));
        check_counts(count_in_disk(source, kQuadrant, 4, 1, 5));
        check_counts(count_in_square(source, kWholeBox, 1, 0.6, 6));  // too little to be squeezed
    }
}

TEST_CASE("sources: positions in spheres have the density of the squeezed cube") {
    const LightSource source = ball(0.3);
    constexpr double kRadius = 1 / kSphereBox;
    const auto position = [&](RandomStream& random) {
        return position_in_box(source, kWholeBox, 1, 1, random);
    };
    // All directions from the centre, where the integral of r² dr is radius³ / 3.
    const CellCounts directions = count_directions(
        {}, kTrials, 8, [&](RandomStream& random) { return normalize(position(random)); },
        [&](const Vec3& d) {
            return position_pdf(source, kWholeBox, 1, 1, 0.5 * d) * std::pow(kRadius, 3) / 3;
        });
    check_counts(directions);
    // Not uniform: a cube's corners are denser.
    CellCounts uniform = directions;
    std::fill(uniform.expected.begin(), uniform.expected.end() - 1,
              double(kTrials) / static_cast<double>(uniform.expected.size() - 1));
    CHECK(!agrees(chi_square(uniform)));
    // All distances, in the direction of a corner's octant or of the others alike: r³ is uniform.
    const UnitSquareCells cells{40, 2};
    check_counts(
        count_cells(cells, cell_masses(cells, [](double, double) { return 1; }), kTrials, 9,
                    [&](RandomStream& random) {
                        Vec3 at = position(random);
                        const double r = length(at) / kRadius;
                        return std::optional(SquarePoint{r * r * r, at.x < 0 ? 0.25 : 0.75});
                    }));
    CHECK(position_pdf(source, kWholeBox, 1, 1, {0.8 * kRadius, 0.7 * kRadius, 0}) == 0);
    // Jittered less, they stay in the cube.
    CHECK(position_pdf(source, kWholeBox, 1, 0.5, {0.4, -0.4, 0.4}) == rounded(1));
    CHECK(position_pdf(source, kWholeBox, 1, 0.5, {0.4, -0.4, 0.6}) == 0);
}

TEST_CASE("sources: positions in tubes are uniform in their box") {
    const LightSource source = tube(0.5, 0.1);
    const auto count = [&](std::size_t across, std::size_t along, std::uint64_t seed) {
        const UnitSquareCells cells{16, 16};
        const auto masses = cell_masses(cells, [&](double x, double y) {
            Vec3 at;
            at[across] = 2 * x - 1;
            at[along] = 2 * y - 1;
            return 8 * position_pdf(source, kWholeBox, 1, 1, at);  // constant along the third axis
        });
        return count_cells(cells, masses, kTrials, seed, [&](RandomStream& random) {
            const Vec3 a = position_in_box(source, kWholeBox, 1, 1, random);
            return std::optional(SquarePoint{0.5 * (a[across] + 1), 0.5 * (a[along] + 1)});
        });
    };
    check_counts(count(0, 1, 10));
    check_counts(count(1, 2, 11));
    check_counts(count(2, 0, 12));
}

TEST_CASE("sources: the parts of a divided panel together are the whole, each with its share") {
    const LightSource source = panel(0.5);
    SourceParts parts;
    Partition{source}({0.3, 0.2, 0.8}, 0.5, parts);
    REQUIRE(parts.count > 8);
    const UnitSquareCells cells{20, 20};
    const auto masses = cell_masses(cells, [](double, double) { return 1; });
    check_counts(count_cells(cells, masses, kTrials, 13, [&](RandomStream& random) {
        double left = random.next();
        const SourcePart* part = parts.part.data();
        while ((left -= part->size.x * part->size.y) > 0) ++part;
        const Vec3 a = position_in_box(source, *part, parts.count, 1, random);
        return std::optional(SquarePoint{0.5 * (a.x + 1), 0.5 * (a.y + 1)});
    }));
}

TEST_CASE("sources: samples look at these positions, with the solid angle of the area they see") {
    const Vec3 point{0.4, -0.2, 0.1};
    for (const LightSource& source :
         {panel(0.5), ring(0.4), distant(0.2), ball(0.3), tube(0.5, 0.1)}) {
        RandomStream random(14);
        for (int i = 0; i < 50; ++i) {
            RandomStream same = random;
            const Vec3 a = position_in_box(source, kWholeBox, 1, 1, same);
            const std::optional<SourceSample> sample = sample_whole(source, point, 1, random);
            REQUIRE(sample);
            const Vec3 way = source.center + source.u * a.x + source.v * a.y + source.w * a.z -
                             (source.is_distant() ? Vec3{} : point);
            const double d = length(way), size = static_cast<double>(source.size);
            CHECK(length(sample->direction - way / d) == within(1e-12, 0));
            if (source.is_distant()) CHECK(sample->solid_angle == rounded(size));
            if (source.is_flat()) {
                const double cosine = -dot(source.normal, way) / d;
                CHECK(sample->solid_angle == rounded(size * cosine / (d * d)));
                // Over solid angle, the density of positions is larger by d² / cosθ.
                const double pdf = position_pdf(source, kWholeBox, 1, 1, a) /
                                   length(cross(source.u, source.v)) * d * d / cosine;
                if (!source.is_round()) CHECK(pdf == float_rounded(1 / sample->solid_angle));
            }
            if (source.is_cylinder()) {
                const double along = dot(way, normalize(source.u)) / d;
                CHECK(sample->solid_angle ==
                      rounded(size * std::sqrt(1 - along * along) / (d * d)));
            }
            if (source.is_round() && !source.is_flat() && !source.is_distant())
                CHECK(sample->solid_angle == rounded(size / (d * d)));
        }
    }
}

TEST_CASE("light choice: each is chosen with the probability whose inverse is its scale") {
    const std::vector<float> sizes{3, 0, 1, 0.5f, 20, 2, 7, 0.01f, 4, 0.0005f};
    std::vector<LightChoice> chosen;
    for (const std::size_t wanted : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
        CAPTURE(wanted);
        std::vector<double> scales(sizes.size()), taken(sizes.size());
        bool constant = true;
        RandomStream random(15 + wanted);
        for (int i = 0; i < kTrials; ++i) {
            choose_lights(sizes, wanted, random.next(), chosen);
            for (const LightChoice& c : chosen) {
                taken[c.which] += 1;
                const auto scale = static_cast<double>(c.scale);
                constant &= scales[c.which] == 0 || scales[c.which] == scale;
                scales[c.which] = scale;
            }
        }
        CHECK(constant);
        for (std::size_t k = 0; k < sizes.size(); ++k) {
            CAPTURE(k);
            if (sizes[k] == 0) {
                CHECK(taken[k] == 0);
                continue;
            }
            REQUIRE(scales[k] > 0);
            const double expected = kTrials / scales[k];
            if (scales[k] == 1) {
                CHECK(taken[k] == kTrials);
                continue;
            }
            // Choices of one trial depend on each other: light by light.
            const auto test = [&](double said) {
                return chi_square({{taken[k], kTrials - taken[k]}, {said, kTrials - said}});
            };
            CAPTURE(test(expected));
            CHECK(agrees(test(expected)));
            if (expected > 0.05 * kTrials) CHECK(!agrees(test(1.1 * expected)));
        }
    }
}
