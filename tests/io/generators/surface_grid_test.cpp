#include "io/generators/surface_grid.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/io/generators/generated.h"

namespace lightwalk {
namespace {

using test::near;

/// A paraboloid, and the point that is left out of it.
constexpr auto paraboloid = [](double s, double t) -> std::optional<Vec3> {
    return Vec3{s, t, s * s + 2 * t * t};
};

}  // namespace

TEST_CASE("surface grid: points at (i/m, j/n), central differences are exact for parabolas") {
    const SurfaceGrid grid(4, 5, true, paraboloid);
    CHECK(grid.point(0, 0) == Vec3{0, 0, 0});
    CHECK(grid.point(4, 5) == Vec3{1, 1, 3});
    const std::vector<Vec3> normals = grid.normals();
    REQUIRE(normals.size() == 5 * 6);
    for (std::size_t i = 0; i <= 4; ++i) {
        for (std::size_t j = 0; j <= 5; ++j) {
            const Vec3& p = grid.point(i, j);
            CHECK(near(normals[i * 6 + j], normalize({-2 * p.x, -4 * p.y, 1})));
        }
    }
}

TEST_CASE("surface grid: next to a gap differences are one-sided, the gap repeats a normal") {
    // The point (3/5, 2/5) is not valid.
    const SurfaceGrid grid(5, 5, true, [](double s, double t) {
        const bool gap = std::abs(s - 0.6) < 0.01 && std::abs(t - 0.4) < 0.01;
        return gap ? std::nullopt : paraboloid(s, t);
    });
    CHECK(!grid.valid(3, 2));
    CHECK(grid.point(3, 2) == Vec3{});
    const std::vector<Vec3> normals = grid.normals();
    const auto normal = [&](std::size_t i, std::size_t j) { return normals[i * 6 + j]; };
    CHECK(near(normal(3, 2), normal(0, 2)));
    CHECK(!near(normal(3, 2), normal(1, 2)));
    const double slope = (0.4 * 0.4 - 0.2 * 0.2) / 0.2;  // from s = 0.2 to 0.4
    CHECK(near(normal(2, 2), normalize({-slope, -4 * 0.4, 1})));
}

TEST_CASE("surface grid: cells are cut along valid corners, else alternately") {
    const auto cut = [](bool b_valid, bool e_valid, std::size_t j) {
        const SurfaceGrid grid(1, 3, false, [&](double s, double t) -> std::optional<Vec3> {
            const double low = static_cast<double>(j) / 3;
            if (s > 0.5 && std::abs(t - low) < 0.01 && !b_valid) return std::nullopt;
            if (s > 0.5 && std::abs(t - low - 1. / 3) < 0.01 && !e_valid) return std::nullopt;
            return paraboloid(s, t);
        });
        const SurfaceCell::Corner first = surface_cell(grid, 0, j).p[0];
        return first.i == 0 ? 'A' : 'B';
    };
    CHECK(cut(true, true, 0) == 'B');
    CHECK(cut(true, true, 1) == 'A');
    CHECK(cut(true, false, 0) == 'A');
    CHECK(cut(true, false, 1) == 'A');
    CHECK(cut(false, true, 0) == 'B');
    CHECK(cut(false, true, 1) == 'B');
}

TEST_CASE("fit_normals: bilinear through the four corners, over the dominant axis' plane") {
    const std::array<Vec3, 4> points = {{{1, 2, .1}, {3, 2, 0}, {1, 5, -.1}, {3, 5.5, .2}}};
    const std::array<Vec3, 4> normals = {{normalize({.1, 0, 1}), normalize({-.1, .2, 1}),
                                          normalize({0, .3, 1}), normalize({.2, .2, 1})}};
    const auto fit = fit_normals(points, normals);
    REQUIRE(fit);
    CHECK(fit->axis == 2);
    for (std::size_t k = 0; k < 4; ++k) {
        const double u = points[k].x;
        const double v = points[k].y;
        CHECK(near(fit->c[0] * (u * v) + fit->c[1] * u + fit->c[2] * v + fit->c[3], normals[k]));
    }
    const auto axis_of = [&](const Vec3& n) {
        const auto turned =
            fit_normals({{{1, 2, 4}, {2, 5, 4}, {1, 3, 5}, {3, 1, 6}}}, {n, n, n, n});
        return turned ? turned->axis : 9;
    };
    CHECK(axis_of({1, .5, .5}) == 0);
    CHECK(axis_of({-.5, -1, .5}) == 1);
    CHECK(axis_of({1, 1, .5}) == 1);  // x only where it is larger than y
    CHECK(axis_of({1, 0, -1}) == 2);  // and either only where it is larger than z
    // Four corners over one line determine nothing.
    CHECK(!fit_normals({{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}}}, normals));
}

}  // namespace lightwalk
