// Configuration and form factors: closed forms against each other, and against what sensors see.
// The cases are those of CIE 171:2006 for area sources and form factors (Maamari & Fontoynont,
// "Analytical tests for investigating the accuracy of lighting programs", Lighting Research &
// Technology 35, 2003).
#include <doctest/doctest.h>

#include "tests/core/theory/measure.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kGlowing = "void glow lit 0 0 4 1 1 1 0\n";
constexpr int kFactorRays = 40000;

/// What a sensor sees of something that glows 1, over π.
double seen_factor(const TestScene& scene, const Vec3& point, const Vec3& normal) {
    return measured(scene, point, normal) / kPi;
}

}  // namespace

TEST_CASE("form factors: Lambert's polygons are Howell's rectangles") {
    for (const double a : {0.3, 1.0, 4.0}) {
        for (const double c : {0.2, 1.5}) {
            const Vec3 up{0, 0, 1};
            CHECK(lambert_factor({0, 0, 0}, up, rectangle({0, 0, c}, {a, 0, 0}, {0, 2, 0})) ==
                  rounded(factor_to_parallel(a, 2, c)));
            CHECK(lambert_factor({0, 0, 0}, up, rectangle({c, 0, 0}, {0, 2, 0}, {0, 0, a})) ==
                  rounded(factor_to_upright(a, 2, c)));
            // What lies below the horizon does not count.
            CHECK(lambert_factor({0, 0, 0}, up, rectangle({c, 0, -9}, {0, 2, 0}, {0, 0, 9 + a})) ==
                  rounded(factor_to_upright(a, 2, c)));
        }
    }
}

TEST_CASE("form factors: a sensor sees Lambert's factor of polygons of any shape and tilt") {
    const std::vector<std::vector<Vec3>> shapes{
        rectangle({-.5, -.5, 1}, {1, 0, 0}, {0, 1, 0}),
        rectangle({2, -1, 0}, {0, 2, 0}, {0, 0, 1.5}),
        {{.2, .1, .8}, {1.4, .3, 1.1}, {.5, 1.3, 1.6}},
        {{1, 0, 1}, {.5, .8, 1}, {-.5, .8, 1}, {-1, 0, 1}, {-.5, -.8, 1}, {.5, -.8, 1}},
        rectangle({1, -1, -2}, {0, 2, 0}, {.3, 0, 4})};
    for (const std::vector<Vec3>& shape : shapes) {
        TestScene scene(kGlowing + polygon("lit", "p", facing(shape, {})),
                        indirect(1, kFactorRays));
        for (const Vec3& normal : {Vec3{0, 0, 1}, normalize(Vec3{.6, .1, .7})}) {
            const Vec3 point{.02, -.03, 0};
            const double factor = lambert_factor(point, normal, shape);
            CAPTURE(factor);
            CHECK(seen_factor(scene, point, normal) == within(kCase, factor));
        }
    }
}

TEST_CASE("form factors: disks, spheres and cylinders as Howell has them") {
    const auto see = [](const std::string& shape, const Vec3& point, const Vec3& normal) {
        return seen_factor(TestScene(kGlowing + "lit " + shape, indirect(1, kFactorRays)), point,
                           normal);
    };
    const Vec3 up{0, 0, 1};
    // Above the centre of a disk: r² / (h² + r²). Of a ring: the difference.
    CHECK(see("ring d 0 0 8 0 0 2 0 0 -1 0 1\n", {}, up) == within(kCase, 1 / 5.));
    CHECK(see("ring d 0 0 8 0 0 2 0 0 -1 1 3\n", {}, up) == within(kCase, 9 / 13. - 1 / 5.));
    // B-13, an element beside a parallel disk, by its distance from the axis.
    const double a = 1.5, h = 2, r = 1, z = 1 + (h * h + r * r) / (a * a), x = r / a;
    CHECK(see("ring d 0 0 8 1.5 0 2 0 0 -1 0 1\n", {}, up) ==
          within(kCase, 0.5 * (1 - (z - 2 * x * x) / std::sqrt(z * z - 4 * x * x))));
    // A sphere wholly above the horizon: (r / d)² times the cosine.
    CHECK(see("sphere s 0 0 4 0 0 2 .8\n", {}, up) == within(kCase, .16));
    CHECK(see("sphere s 0 0 4 1.5 0 2 .8\n", {}, up) == within(kCase, .64 / 6.25 * .8));
    // B-31 an upright cylinder from its foot, as an element whose normal passes through its axis:
    // half of an endless one, r / (2 d).
    CHECK(see("cylinder c 0 0 7 2 0 0 2 0 4000 .5\n", {}, {1, 0, 0}) == within(kCase, .125));
}

TEST_CASE("form factors: mean over a surface is the factor between surfaces") {
    const GaussRule rule(6);
    const auto mean = [&](const TestScene& scene, const Vec3& corner, const Vec3& u, const Vec3& v,
                          const Vec3& normal) {
        double sum = 0;
        for (std::size_t i = 0; i < rule.at.size(); ++i)
            for (std::size_t k = 0; k < rule.at.size(); ++k)
                sum += rule.weight[i] * rule.weight[k] *
                       seen_factor(scene, corner + u * rule.at[i] + v * rule.at[k], normal);
        return sum;
    };
    const RenderOptions options = indirect(1, 4096);
    const Vec3 up{0, 0, 1};
    TestScene parallel(kGlowing + polygon("lit", "p", rectangle({0, 0, 1}, {0, 1.5, 0}, {2, 0, 0})),
                       options);
    CHECK(mean(parallel, {}, {2, 0, 0}, {0, 1.5, 0}, up) ==
          within(kCase, factor_between_parallel(2, 1.5, 1)));
    TestScene upright(kGlowing + polygon("lit", "p", rectangle({}, {0, 2, 0}, {0, 0, 1.2})),
                      options);
    const double forth = mean(upright, {}, {1.5, 0, 0}, {0, 2, 0}, up);
    CHECK(forth == within(kCase, factor_between_upright(2, 1.5, 1.2)));
    // Reciprocity: what the wall sees of the floor, by the ratio of their areas.
    TestScene back(kGlowing + polygon("lit", "p", rectangle({}, {1.5, 0, 0}, {0, 2, 0})), options);
    CHECK(mean(back, {}, {0, 2, 0}, {0, 0, 1.2}, {1, 0, 0}) * 1.2 / 1.5 == within(kCase, forth));
    // Rings of equal area of a disk that looks at a larger one.
    TestScene disk(kGlowing + "lit ring d 0 0 8 0 0 1 0 0 -1 0 1.5\n", options);
    double disks = 0;
    for (std::size_t i = 0; i < rule.at.size(); ++i)
        disks += rule.weight[i] * seen_factor(disk, {std::sqrt(rule.at[i]), 0, 0}, up);
    CHECK(disks == within(kCase, factor_between_disks(1, 1.5, 1)));
}
