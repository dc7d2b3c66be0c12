// Boxes of parts of polygons: they leave nothing out, and holes and corners free.
#include "core/geometry/pieces.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/bounds.h"
#include "tests/core/geometry/geometry_scenes.h"

namespace lightwalk {
namespace {

using test::surface;

struct Divided {
    explicit Divided(std::vector<double> corners) {
        test::TestModels scene;
        scene.add(surface(PrimitiveType::polygon, std::move(corners), 0, test::kOpaque));
        tables = std::make_unique<test::TestModels::Tables>(scene);
        model = std::make_unique<ModelPrimitives>(tables->surfaces, tables->input.models[0],
                                                  TeamOfOne());
        pieces = divide_primitives(*model, TeamOfOne());
    }
    [[nodiscard]] PolygonShape polygon() const {
        return std::get<PolygonShape>(tables->surfaces[SurfaceId{0}].shape());
    }
    [[nodiscard]] bool holds(const Vec3& p) const {
        for (std::size_t i = 0; i < pieces.size(); ++i)
            if (contains(pieces.box(i, *model), p)) return true;
        return false;
    }
    std::unique_ptr<test::TestModels::Tables> tables;
    std::unique_ptr<ModelPrimitives> model;
    Pieces pieces;
};

Vec3 onto_plane(const PolygonShape& polygon, Vec3 p) {
    const auto k = static_cast<std::size_t>(polygon.drop_axis);
    p[k] += (polygon.offset - dot(polygon.normal, p)) / polygon.normal[k];
    return p;
}

}  // namespace

TEST_CASE("a window in a wall is in no box, the wall around it is") {
    const Divided wall({0, 0, 0, 10, 0, 0, 10, 0, 6, 0, 0, 6, 0, 0, 0,  // and the hole
                        2, 0, 2, 2,  0, 4, 8,  0, 4, 8, 0, 2, 2, 0, 2});
    CHECK(wall.pieces.size() >= 4);
    CHECK(wall.pieces.size() <= 16);
    for (const Vec3& p : {Vec3{5, 0, 3}, Vec3{2.01, 0, 2.01}, Vec3{7.99, 0, 3.99}})
        CHECK_FALSE(wall.holds(p));
    for (const Vec3& p :
         {Vec3{5, 0, 1.999999}, Vec3{0, 0, 0}, Vec3{1.999999, 0, 3}, Vec3{8, 0, 4}, Vec3{2, 0, 2}})
        CHECK(wall.holds(p));
}

TEST_CASE("a rectangle along the axes stays in one piece") {
    CHECK(Divided({0, 0, 1, 4, 0, 1, 4, 2, 1, 0, 2, 1}).pieces.size() == 1);
}

TEST_CASE("the boxes of a slanted roof do not fill the attic") {
    const Divided roof({0, 0, 0, 12, 0, 0, 12, 4, 4, 0, 4, 4});
    CHECK_FALSE(roof.holds({6, 2, 1}));
    CHECK_FALSE(roof.holds({6, 1, 2}));
    CHECK(roof.holds({6, 2, 2}));
}

TEST_CASE("every point that a polygon takes for its own is in one of its boxes") {
    RandomStream random(5);
    std::size_t most = 0;
    for (int round = 0; round < 200; ++round) {
        // Stars, convex ones and self-crossing ones, turned at random.
        const Vec3 u =
            normalize(Vec3{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5});
        const Vec3 v = cross(u, perpendicular(u));
        const int count = 3 + static_cast<int>(20 * random.next());
        const double skip = random.next() < 0.2 ? 2 : 1;
        std::vector<double> corners;
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * kPi * skip * i / count;
            const double radius = round % 3 == 0 ? 3 : 0.5 + 3 * random.next();
            const Vec3 p = u * (radius * std::cos(angle)) + v * (radius * std::sin(angle));
            for (std::size_t k = 0; k < 3; ++k) corners.push_back(p[k]);
        }
        const Divided star(corners);
        if (star.pieces.size() == 0) continue;  // degenerate
        most = std::max(most, star.pieces.size());
        const PolygonShape polygon = star.polygon();
        for (int i = 0; i < 400; ++i) {
            Vec3 p = u * (7 * random.next() - 3.5) + v * (7 * random.next() - 3.5);
            if (i % 4 == 0) {  // about an edge
                const auto n = polygon.vertices.size();
                const auto edge = static_cast<std::size_t>(random.next() * static_cast<double>(n));
                const double t = random.next();
                p = polygon.vertices[edge] * (1 - t) + polygon.vertices[(edge + 1) % n] * t +
                    u * (4e-6 * (random.next() - 0.5)) + v * (4e-6 * (random.next() - 0.5));
            }
            p = onto_plane(polygon, p);
            if (contains(polygon, p, nullptr)) REQUIRE(star.holds(p));
        }
    }
    CHECK(most > 8);
}

}  // namespace lightwalk
