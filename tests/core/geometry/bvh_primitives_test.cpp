// Boxes of parts of polygons and cones: they leave nothing out, and holes, corners and the air
// around branches free.
#include "core/geometry/bvh_primitives.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/bounds.h"
#include "tests/core/geometry/geometry_scenes.h"

namespace lightwalk {
namespace {

using test::surface;

struct Divided {
    explicit Divided(std::vector<double> corners)
        : Divided({surface(PrimitiveType::polygon, std::move(corners), 0, test::kOpaque)}) {}
    explicit Divided(std::vector<test::TestSurface> surfaces) {
        test::TestModels scene;
        for (test::TestSurface& surface : surfaces) scene.add(std::move(surface));
        tables = std::make_unique<test::TestModels::Tables>(scene);
        model = std::make_unique<ModelPrimitives>(tables->surfaces, tables->input.models[0],
                                                  SerialTaskRunner());
        bvh_primitives = divide_primitives(*model, SerialTaskRunner());
    }
    [[nodiscard]] PolygonShape polygon() const {
        return std::get<PolygonShape>(tables->surfaces[SurfaceId{0}].shape());
    }
    [[nodiscard]] bool holds(const Vec3& p) const {
        for (std::size_t i = 0; i < bvh_primitives.size(); ++i)
            if (contains(bvh_primitives.box(i, *model), p)) return true;
        return false;
    }
    std::unique_ptr<test::TestModels::Tables> tables;
    std::unique_ptr<ModelPrimitives> model;
    BvhPrimitives bvh_primitives;
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
    CHECK(wall.bvh_primitives.size() >= 4);
    CHECK(wall.bvh_primitives.size() <= 16);
    for (const Vec3& p : {Vec3{5, 0, 3}, Vec3{2.01, 0, 2.01}, Vec3{7.99, 0, 3.99}})
        CHECK_FALSE(wall.holds(p));
    for (const Vec3& p :
         {Vec3{5, 0, 1.999999}, Vec3{0, 0, 0}, Vec3{1.999999, 0, 3}, Vec3{8, 0, 4}, Vec3{2, 0, 2}})
        CHECK(wall.holds(p));
}

TEST_CASE("a rectangle along the axes stays in one piece") {
    CHECK(Divided({0, 0, 1, 4, 0, 1, 4, 2, 1, 0, 2, 1}).bvh_primitives.size() == 1);
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
        if (star.bvh_primitives.size() == 0) continue;  // degenerate
        most = std::max(most, star.bvh_primitives.size());
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

TEST_CASE("a wall with a window is divided wherever it stands among thousands of small polygons") {
    constexpr std::size_t kSmall = 2 * kGrain;
    for (const std::size_t before : {std::size_t{0}, kGrain - 1, kGrain, kSmall}) {
        std::vector<test::TestSurface> surfaces;
        for (std::size_t i = 0; i <= kSmall; ++i) {
            const double x = 1e-3 * static_cast<double>(i);
            surfaces.push_back(
                i == before ? surface(PrimitiveType::polygon,
                                      {0, 0, 0, 10, 0, 0, 10, 0, 6, 0, 0, 6, 0, 0, 0,
                                       2, 0, 2, 2,  0, 4, 8,  0, 4, 8, 0, 2, 2, 0, 2},
                                      0, test::kOpaque)
                            : surface(PrimitiveType::polygon, {x, 9, 0, x + 1e-3, 9, 0, x, 9, 1e-3},
                                      0, test::kOpaque));
        }
        const Divided all(std::move(surfaces));
        CHECK_FALSE(all.holds({5, 0, 3}));
        CHECK(all.holds({5, 0, 1}));
        CHECK(all.bvh_primitives.size() < kSmall + 16);
        for (std::uint32_t i = 0; i <= kSmall; ++i)
            REQUIRE(half_area(all.model->hit_bounds(i)) <= all.model->half_area_at_most(i));
        CHECK(all.model->half_area_at_most(before < kGrain ? kSmall : 0) < 1e-4);
    }
}

TEST_CASE("every point that a small slanted triangle takes for its own is in its box") {
    // The inside test's tolerance is an area: of short edges it reaches far.
    RandomStream random(6);
    int beyond = 0;
    for (int round = 0; round < 3000; ++round) {
        const double size = std::pow(10, -4 * random.next());  // 1 m to .1 mm
        std::vector<double> corners;
        for (int i = 0; i < 9; ++i) corners.push_back(size * (random.next() - 0.5));
        const ValidatedShape valid =
            make_shape(test::kept_primitive(PrimitiveType::polygon, corners));
        const auto* const polygon = std::get_if<PolygonShape>(&valid.shape);
        if (polygon == nullptr) continue;
        const Bounds box = hit_bounds(valid.shape), tight = grown(bounds_of(valid.shape), 4e-6);
        for (int i = 0; i < 100; ++i) {
            const Vec3 corner = polygon->vertices[static_cast<std::size_t>(i % 3)];
            const Vec3 off{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5};
            const double reach = std::min(4e-6 / size, size);
            const Vec3 p = onto_plane(*polygon, corner + off * reach);
            if (!contains(*polygon, p, nullptr)) continue;
            REQUIRE(contains(box, p));
            beyond += contains(tight, p) ? 0 : 1;
        }
    }
    CHECK(beyond > 100);
}

TEST_CASE(
    "the boxes of a slanted branch leave the air around it free, an upright trunk is one box") {
    const Divided branch(
        {surface(PrimitiveType::cone, {0, 0, 0, 4, 4, 4, 0.1, 0.05}, 0, test::kOpaque)});
    CHECK(branch.bvh_primitives.size() == 16);
    CHECK_FALSE(branch.holds({1, 2, 2}));
    CHECK_FALSE(branch.holds({3.5, 3.5, 3}));
    for (const double s : {0.0, 0.3, 2.0, 4.0}) CHECK(branch.holds({s, s, s}));
    for (const PrimitiveType type : {PrimitiveType::cylinder, PrimitiveType::tube})
        CHECK(Divided({surface(type, {1, 1, 0, 1, 1, 9, 0.2}, 0, test::kOpaque)})
                  .bvh_primitives.size() == 1);
}

TEST_CASE("every hit of a cone, cup, cylinder or tube is in one of its boxes") {
    RandomStream random(8);
    std::size_t most = 0;
    int hits = 0;
    for (int round = 0; round < 300; ++round) {
        const auto type = std::array{PrimitiveType::cone, PrimitiveType::cup,
                                     PrimitiveType::cylinder, PrimitiveType::tube}[round % 4U];
        const auto somewhere = [&](double size) {
            return Vec3{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5} * size;
        };
        const Vec3 from = somewhere(20), to = from + somewhere(8);
        std::vector<double> reals{from.x, from.y, from.z, to.x, to.y, to.z};
        reals.push_back(random.next() * (round % 3 == 0 ? 1 : 0.1));
        if (round % 4 < 2) reals.push_back(random.next() < 0.2 ? 0 : random.next());
        const Divided cone({surface(type, reals, 0, test::kOpaque)});
        if (cone.bvh_primitives.size() == 0) continue;  // degenerate
        most = std::max(most, cone.bvh_primitives.size());
        for (int i = 0; i < 200; ++i) {
            const Vec3 aim = from + (to - from) * random.next() + somewhere(0.2),
                       origin = aim + somewhere(20);
            const Vec3 direction = normalize(aim - origin);
            const auto hit = cone.model->intersect(0, origin, direction, kHuge);
            if (!hit) continue;
            REQUIRE(cone.holds(origin + direction * hit->t));
            ++hits;
        }
    }
    CHECK(most == 16);
    CHECK(hits > 20'000);
}

TEST_CASE("of many branches the long ones are divided, up to a bound for all together") {
    std::vector<test::TestSurface> branches;
    constexpr std::size_t kCount = 4000;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double length = i % 2 == 0 ? 3 : 2, x = 0.01 * static_cast<double>(i);
        branches.push_back(surface(PrimitiveType::cylinder,
                                   {x, 0, 0, x + length, length, length, 0.001}, 0, test::kOpaque));
    }
    const Divided all(std::move(branches));
    CHECK(all.bvh_primitives.size() > kCount + 20'000 + kCount / 2 - 16);
    CHECK(all.bvh_primitives.size() <= kCount + 20'000 + kCount / 2);
    for (std::size_t i = all.bvh_primitives.whole; i < all.bvh_primitives.size(); ++i)
        CHECK(all.bvh_primitives.primitive(i) % 2 == 0);
}

TEST_CASE("in a large model the two triangles of a cell are a pair, and rays meet each of them") {
    constexpr int kSide = 262;
    test::TestModels scene;
    const auto point = [](int i, int j) {
        return Vec3{0.01 * i, 0.01 * j, 0.02 * std::sin(0.1 * i) * std::cos(0.1 * j)};
    };
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            for (const int half : {0, 1}) {
                std::vector<double> corners;
                for (const Vec3& p :
                     {point(i, j), half == 0 ? point(i + 1, j) : point(i + 1, j + 1),
                      half == 0 ? point(i + 1, j + 1) : point(i, j + 1)})
                    corners.insert(corners.end(), {p.x, p.y, p.z});
                scene.add(surface(PrimitiveType::polygon, corners, 0, test::kOpaque));
            }
        }
    }
    scene.add(surface(PrimitiveType::sphere, {1, 1, 1, .1}, 0, test::kOpaque));
    const test::TestModels::Tables tables(scene);
    const ModelPrimitives model(tables.surfaces, tables.input.models[0], SerialTaskRunner());
    const BvhPrimitives bvh_primitives = divide_primitives(model, SerialTaskRunner());
    CHECK(bvh_primitives.pairs > std::size_t{kSide} * kSide * 9 / 10);
    std::vector<int> times(model.size());
    for (std::size_t bvh_primitive = 0; bvh_primitive < bvh_primitives.size(); ++bvh_primitive) {
        for (std::uint32_t k = 0; k < bvh_primitives.count(bvh_primitive); ++k) {
            const std::uint32_t primitive = bvh_primitives.primitive(bvh_primitive) + k;
            ++times[primitive];
            const Bounds own = model.hit_bounds(primitive);
            REQUIRE(contains(bvh_primitives.box(bvh_primitive, model), own.lower));
            REQUIRE(contains(bvh_primitives.box(bvh_primitive, model), own.upper));
        }
    }
    CHECK(std::ranges::all_of(times, [](int n) { return n == 1; }));

    const Geometry geometry(tables.input);
    RandomStream random(7);
    for (int ray = 0; ray < 30; ++ray) {
        const Vec3 from{3 * random.next(), 3 * random.next(), 1 + random.next()};
        const Vec3 to{2.6 * random.next(), 2.6 * random.next(), 0};
        const Vec3 direction = normalize(to - from);
        double nearest = kHuge;
        for (std::uint32_t i = 0; i < model.size(); ++i) {
            const auto hit = model.intersect(i, from, direction, nearest);
            if (hit) nearest = hit->t;
        }
        const Hit hit = geometry.intersect({from, direction});
        REQUIRE(hit.exists() == (nearest < kHuge));
        if (hit.exists()) REQUIRE(hit.t == doctest::Approx(nearest).epsilon(1e-6));
        const bool blocked =
            geometry.visibility({from, direction}, kNoSurface) != Visibility::clear;
        REQUIRE(blocked == hit.exists());
    }
}

}  // namespace lightwalk
