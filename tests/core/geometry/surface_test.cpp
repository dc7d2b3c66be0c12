// Shapes in columns: each is the one that make_shape makes, whoever shares out the work.
#include "core/geometry/surface.h"

#include <doctest/doctest.h>

#include "tests/backward_task_runner.h"
#include "tests/core/geometry/geometry_scenes.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Good surfaces of all kinds, and some that are ignored or changed.
SurfaceList many_surfaces(std::size_t count) {
    SurfaceList list;
    Random random(3);
    for (std::size_t i = 0; i < count; ++i) {
        TestSurface next = random_surface(random);
        if (i % 97 == 5) next.reals.assign(next.reals.size(), 0);  // degenerate, but for rings
        if (i % 101 == 7)
            next = surface(PrimitiveType::sphere, {0, 0, 0, -1}, 0, kOpaque);  // a bubble
        if (i % 103 == 9) next = surface(PrimitiveType::source, {0, 0, 1, 180}, 1, kOpaque);
        next.where = {"many.rad", static_cast<std::int32_t>(i + 1)};
        list.add(next);
    }
    return list;
}

bool same_shape(const Shape& a, const Shape& b) {
    if (a.index() != b.index()) return false;
    const Vec3 from{-3, 0.2, 0.4};
    Random random(8);
    for (int i = 0; i < 20; ++i) {
        const Vec3 direction = normalize(random.in_box(2) - from);
        const auto hit = intersect(a, from, direction, kHuge),
                   other = intersect(b, from, direction, kHuge);
        if (hit.has_value() != other.has_value()) return false;
        if (hit && (hit->t != other->t || !(hit->normal == other->normal))) return false;
    }
    return true;
}

/// Columns that a test may change.
struct StoredShapes {
    explicit StoredShapes(const SurfaceShapes& shapes)
        : rows(shapes.columns().rows.begin(), shapes.columns().rows.end()),
          others(&shapes.columns()) {}
    [[nodiscard]] SurfaceShapes shapes(const SurfaceList& list) const {
        SurfaceShapes::Columns columns;
        columns.rows = Column<ShapeRow>::mapped(rows);
        columns.spheres = Column<SphereShape>::mapped(others->spheres.values());
        columns.cones = Column<ConeShape>::mapped(others->cones.values());
        columns.rings = Column<RingShape>::mapped(others->rings.values());
        columns.sources = Column<SourceShape>::mapped(others->sources.values());
        return {std::move(columns), list};
    }
    std::vector<ShapeRow> rows;
    const SurfaceShapes::Columns* others;
};

}  // namespace

TEST_CASE("the table of shapes holds what make_shape makes of each surface") {
    const SurfaceList list = many_surfaces(2 * kGrain + 77);
    const SurfaceShapes shapes = make_shapes(list, SerialTaskRunner()),
                        backward = make_shapes(list, BackwardTaskRunner());
    REQUIRE(shapes.size() == list.size());
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const SurfacePrimitive surface = list[i];
        const ValidatedShape valid = make_shape(surface);
        REQUIRE(shapes.row(i).type == valid.type);
        REQUIRE(shapes.row(i).modifier == surface.modifier);
        REQUIRE(shapes.row(i).index() == backward.row(i).index());
        REQUIRE(same_shape(shapes.shape(list, i), valid.shape));
        if (!valid.warning.empty())
            warnings.push_back("many.rad:" + std::to_string(i + 1) + ": " +
                               std::string(to_string(surface.type)) + " \"it\": " + valid.warning);
    }
    CHECK(warnings.size() > 200);
    CHECK(shapes.columns().warnings == warnings);
    CHECK(backward.columns().warnings == warnings);
}

TEST_CASE("triangles that share corners have the shapes that they have alone") {
    SurfaceList list;
    Random random(4);
    std::vector<Vec3> corners;
    for (int i = 0; i < 40; ++i) corners.push_back(random.in_box(2));
    std::vector<TestSurface> alone;
    for (int i = 0; i < 500; ++i) {
        std::vector<double> reals;
        for (int k = 0; k < 3; ++k) {
            const Vec3& p = corners[static_cast<std::size_t>(random.below(40))];
            reals.insert(reals.end(), {p.x, p.y, p.z});
        }
        alone.push_back(surface(PrimitiveType::polygon, reals, 0, kOpaque));
        list.add(alone.back());
    }
    const SurfaceShapes shapes = make_shapes(list, SerialTaskRunner());
    const StoredShapes stored(shapes);
    const SurfaceShapes again = stored.shapes(list);
    std::size_t shared = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const ValidatedShape valid = make_shape(view_of(alone[i]));
        REQUIRE(same_shape(shapes.shape(list, i), valid.shape));
        REQUIRE(same_shape(again.shape(list, i), valid.shape));
        const ShapeRow& row = shapes.row(i);
        if (row.manner.outline == Outline::shared) ++shared;
        if (row.kind != ShapeKind::polygon) continue;  // two corners the same: no area
        const auto& numbers = list.columns();
        for (int ray = 0; ray < 20; ++ray) {
            const Vec3 from = random.in_box(3), direction = random.direction();
            const auto hit = intersect(row.plane, row.manner,
                                       {numbers.reals.data(), numbers.corners.data()}, from,
                                       direction, kHuge),
                       other = intersect(valid.shape, from, direction, kHuge);
            REQUIRE(hit.has_value() == other.has_value());
            if (hit) REQUIRE(hit->t == other->t);
        }
    }
    CHECK(shared > 400);
}

TEST_CASE("of bad surfaces the first in the list's order is told") {
    SurfaceList list = many_surfaces(3 * kGrain);
    for (const int line : {100001, 100002}) {
        Primitive bad = primitive(PrimitiveType::polygon, {0, 0, 0, 1, 1});
        bad.where.line = line;
        list.add(bad);
        for (std::size_t i = 0; i < 2 * kGrain; ++i) list.add(many_surfaces(1)[0]);
    }
    CHECK_THROWS_WITH_AS(static_cast<void>(make_shapes(list, BackwardTaskRunner())),
                         doctest::Contains("room.rad:100001: polygon"), InputError);
}

TEST_CASE("stored shapes are taken where they fit their list, and refused elsewhere") {
    const SurfaceList list = many_surfaces(300);
    const SurfaceShapes shapes = make_shapes(list, SerialTaskRunner());
    const StoredShapes good(shapes);
    const SurfaceShapes again = good.shapes(list);
    for (std::size_t i = 0; i < list.size(); ++i)
        CHECK(same_shape(again.shape(list, i), shapes.shape(list, i)));
    CHECK(again.own_bytes() == 0);

    std::size_t polygon = 0, sphere = 0;
    while (shapes.row(polygon).kind != ShapeKind::polygon) ++polygon;
    while (shapes.row(sphere).kind != ShapeKind::sphere) ++sphere;
    const auto refuses = [&](auto change) {
        StoredShapes bad = good;
        change(bad);
        CHECK_THROWS_WITH_AS(static_cast<void>(bad.shapes(list)),
                             doctest::Contains("damaged shapes"), InputError);
    };
    refuses([](StoredShapes& s) { s.rows.pop_back(); });
    refuses([&](StoredShapes& s) { s.rows[polygon].plane.first = 100000; });
    refuses([&](StoredShapes& s) { s.rows[sphere].plane.first = 100000; });
    refuses([&](StoredShapes& s) { s.rows[sphere].kind = ShapeKind::cone; });
    refuses([&](StoredShapes& s) { s.rows[sphere].kind = static_cast<ShapeKind>(77); });
    refuses([&](StoredShapes& s) { s.rows[sphere].type = PrimitiveType::cone; });
    refuses([&](StoredShapes& s) { s.rows[sphere].type = static_cast<PrimitiveType>(200); });
    refuses([&](StoredShapes& s) { s.rows[sphere].modifier = 555; });
    refuses([&](StoredShapes& s) { s.rows[polygon].manner.drop_axis = 3; });
    refuses([&](StoredShapes& s) { s.rows[polygon].manner.outline = Outline::shared; });
    refuses([&](StoredShapes& s) { s.rows[polygon].manner.outline = static_cast<Outline>(3); });
    refuses([&](StoredShapes& s) { s.rows[polygon].plane.first += 3; });
    refuses([&](StoredShapes& s) { s.rows[polygon].plane.corners += 1; });
    refuses([&](StoredShapes& s) { s.rows[polygon].plane.corners = 2; });
    refuses([&](StoredShapes& s) { s.rows[polygon].plane.offset = std::nan(""); });
    refuses([&](StoredShapes& s) { s.rows[polygon].plane.normal = {}; });
}

TEST_CASE("a table of surfaces numbers those of each model side by side") {
    TestModels scene;
    scene.models.resize(3);
    scene.add(surface(PrimitiveType::sphere, {0, 0, 0, 1}, 4, kGlass));
    scene.add(surface(PrimitiveType::polygon, {0, 0, 0, 1, 0, 0, 0, 1, 0}, 5, kOpaque), 2);
    scene.add(surface(PrimitiveType::cone, {0, 0, 0, 0, 0, 1, 1, 1}, 6, kOpaque), 2);
    const TestModels::Tables tables(scene);  // model 1 has none
    const SurfaceTable& table = tables.surfaces;
    REQUIRE(table.size() == 3);
    CHECK(table[SurfaceId{0}].type() == PrimitiveType::sphere);
    CHECK(table[SurfaceId{0}].traits().transparent);
    CHECK(table[SurfaceId{1}].is_flat());
    CHECK(table[SurfaceId{1}].modifier() == modifier_of(5, kOpaque));
    CHECK(table[SurfaceId{1}].name() == "it");
    CHECK(to_prefix(table[SurfaceId{2}].where()) == "room.rad:7: ");
    CHECK(table[SurfaceId{2}].type() == PrimitiveType::cylinder);  // of equal radii
    CHECK(std::holds_alternative<ConeShape>(table[SurfaceId{2}].shape()));
    CHECK(&table.part_of(SurfaceId{2}) == &table.part(2));
}
