// Triangle meshes, placed: smoothed normals, texture coordinates, materials by triangle.
#include <doctest/doctest.h>

#include "core/geometry/geometry.h"
#include "tests/core/geometry/geometry_scenes.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

using Vertices = Column<MeshModel::Vertex>;
using Triangles = Column<MeshModel::Triangle>;

/// Two triangles that share a diagonal: the unit square at z = 0, materials 0 and 1.
MeshModel two_triangles() {
    MeshModel mesh;
    mesh.positions = Vertices({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const double s = std::sqrt(0.5);
    mesh.normals = Vertices({{-s, 0, s}, {s, 0, s}, {s, 0, s}, {-s, 0, s}});
    mesh.us = Column<double>({0, 1, 1, 0});
    mesh.vs = Column<double>({0, 0, 1, 1});
    MeshModel::Triangle low, high;
    low.v[0] = 0, low.v[1] = 1, low.v[2] = 2, low.material = 0;
    high.v[0] = 0, high.v[1] = 2, high.v[2] = 3, high.material = 1;
    low.has_normals = low.has_uvs = high.has_normals = high.has_uvs = true;
    mesh.triangles = Triangles({low, high});
    return mesh;
}

template <class T, class Change>
Column<T> changed(const Column<T>& column, const Change& change) {
    std::vector<T> values(column.begin(), column.end());
    change(values);
    return Column<T>(values);
}

/// A scene with the mesh as model 1, placed by `transform`; surface 0 places it, surface 1 is
/// the mesh's "M-Tri".
TestModels placed(const MeshModel& mesh, const Transform& transform, bool overrides = false) {
    TestModels scene;
    scene.models.resize(2);
    TestSurface triangles;
    triangles.type = PrimitiveType::mesh;
    triangles.where = {"m.rtm", 0};
    scene.add(triangles, 1);
    MeshPart part;
    part.mesh = &mesh;
    part.materials = {ModifierId{20}, ModifierId{21}};
    part.traits = {kOpaque, kGlass};
    scene.models[1].geometry.meshes.push_back(part);
    scene.place(1, 0, transform, overrides, 30);
    return scene;
}

}  // namespace

TEST_CASE(
    "a mesh hit has its triangle's material, interpolated coordinates and the smoothed normal") {
    const MeshModel mesh = two_triangles();
    const TestModels scene = placed(mesh, Transform{});
    const BuiltGeometry geometry = scene.build();
    const Hit low = geometry.intersect({{0.75, 0.25, 1}, {0, 0, -1}});
    REQUIRE(low.exists());
    CHECK(low.surface == SurfaceId{1});
    CHECK(low.modifier == ModifierId{20});
    CHECK(low.instance == InstanceId{0});
    CHECK(low.normal == Vec3{0, 0, 1});
    CHECK(low.u == rounded(0.75));
    CHECK(low.v == rounded(0.25));
    CHECK(length(low.perturbation - (normalize(Vec3{0.5, 0, 1}) - Vec3{0, 0, 1})) < kRounding);
    const Hit high = geometry.intersect({{0.25, 0.75, -1}, {0, 0, 1}});
    CHECK(high.modifier == ModifierId{21});
    CHECK(high.cos_out == -1);
    CHECK(high.u == rounded(0.25));
    CHECK(geometry.visibility({{0.75, 0.25, 1}, {0, 0, -1}}, kNoSurface) == Visibility::blocked);
    CHECK(geometry.visibility({{0.25, 0.75, 1}, {0, 0, -1}}, kNoSurface) ==
          Visibility::needs_shading);
    CHECK_FALSE(geometry.intersect({{1.1, 0.5, 1}, {0, 0, -1}}).exists());
}

TEST_CASE("normals and perturbations turn, mirror and keep their length with the placement") {
    const MeshModel mesh = two_triangles();
    const TestModels scene = placed(mesh, similarity(3, true, {0, 1, 0}, kPi / 2, {0, 0, 7}));
    const BuiltGeometry geometry = scene.build();
    const Transform& to_world = geometry.instance_transform(InstanceId{0});
    const Vec3 target = to_world.forward.point({0.75, 0.25, 0});
    const Vec3 normal = to_world.forward.vector({0, 0, 1}) / 3;
    const Hit hit = geometry.intersect({target + normal * 5, -normal});
    REQUIRE(hit.exists());
    CHECK(hit.t == rounded(5));
    CHECK(hit.cos_out == rounded(1));
    CHECK(length(hit.normal - normal) < kRounding);
    const Vec3 smooth = to_world.forward.vector(normalize(Vec3{0.5, 0, 1})) / 3;
    CHECK(length(hit.normal + hit.perturbation - smooth) < kRounding);
    CHECK(hit.u == rounded(0.75));
}

TEST_CASE("a placement with a modifier shades the whole mesh in the scene's space") {
    const MeshModel mesh = two_triangles();
    const TestModels scene = placed(mesh, Transform{}, true);
    const BuiltGeometry geometry = scene.build();
    const Hit hit = geometry.intersect({{0.25, 0.75, 1}, {0, 0, -1}});
    CHECK(hit.surface == SurfaceId{0});
    CHECK(hit.modifier == modifier_of(30, kOpaque));
    CHECK(hit.instance == kWorld);
    CHECK(geometry.visibility({{0.25, 0.75, 1}, {0, 0, -1}}, kNoSurface) == Visibility::blocked);
}

TEST_CASE("no ray slips between the triangles of a closed mesh") {
    // an octahedron, hit at its corners, edges and faces from all sides
    MeshModel mesh;
    mesh.positions =
        Vertices({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
    for (const std::uint32_t x : {0U, 1U}) {
        for (const std::uint32_t y : {2U, 3U}) {
            for (const std::uint32_t z : {4U, 5U}) {
                MeshModel::Triangle t;
                t.v[0] = x, t.v[1] = y, t.v[2] = z;
                mesh.triangles.push_back(t);
            }
        }
    }
    const Transform turned = similarity(0.3, false, {1, 2, 3}, 1.1, {5, -3, 2});
    const TestModels scene = placed(mesh, turned);
    const BuiltGeometry geometry = scene.build();
    Random random(4);
    for (int i = 0; i < 3000; ++i) {
        Vec3 p = random.direction();
        if (i % 3 == 0) p[static_cast<std::size_t>(random.below(3))] = 0;  // towards an edge
        if (i % 30 == 0) p = {0, 0, p.z < 0 ? -1.0 : 1.0};                 // towards a corner
        p = p / (std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
        const Vec3 center = turned.forward.point({}), at = turned.forward.point(p);
        const Hit outward = geometry.intersect({center, normalize(at - center)});
        REQUIRE(outward.exists());
        CHECK(length(outward.position - at) < kRounding);
        CHECK(outward.modifier == kVoid);  // no material: shading lets the ray pass
    }
}

TEST_CASE("a mesh of many triangles is hit where they are, and weighs little in the search") {
    // a height field: cells of two triangles, whose materials take turns
    constexpr std::uint32_t kCells = 100;
    Random random(8);
    MeshModel mesh;
    for (std::uint32_t i = 0; i <= kCells; ++i) {
        for (std::uint32_t j = 0; j <= kCells; ++j)
            mesh.positions.push_back({1.0 * i, 1.0 * j, random.uniform(-1, 1)});
    }
    for (std::uint32_t i = 0; i < kCells; ++i) {
        for (std::uint32_t j = 0; j < kCells; ++j) {
            const std::uint32_t at = i * (kCells + 1) + j, next = at + kCells + 1;
            MeshModel::Triangle low, high;  // of the diagonal from (i, j)
            low.v[0] = at, low.v[1] = next, low.v[2] = next + 1, low.material = 0;
            high.v[0] = at, high.v[1] = next + 1, high.v[2] = at + 1, high.material = 1;
            mesh.triangles.push_back(low);
            mesh.triangles.push_back(high);
        }
    }
    const Transform turned = similarity(0.3, false, {1, 2, 3}, 1.1, {5, -3, 2});
    const TestModels scene = placed(mesh, turned);
    const BuiltGeometry geometry = scene.build();
    for (int ray = 0; ray < 2000; ++ray) {
        const double x = random.uniform(0, kCells), y = random.uniform(0, kCells);
        const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
        const double u = x - i, v = y - j;
        const bool low = u > v;
        const auto z = [&](std::uint32_t a, std::uint32_t b) {
            return mesh.positions[(i + a) * (kCells + 1) + j + b].z;
        };
        const double height = low ? z(0, 0) * (1 - u) + z(1, 0) * (u - v) + z(1, 1) * v
                                  : z(0, 0) * (1 - v) + z(0, 1) * (v - u) + z(1, 1) * u;
        const Vec3 origin = turned.forward.point({x, y, 3});
        const Vec3 direction = normalize(turned.forward.vector({0, 0, -1}));
        const Hit hit = geometry.intersect({origin, direction});
        REQUIRE(hit.exists());
        CHECK(hit.modifier == ModifierId{low ? 20 : 21});
        CHECK(length(hit.position - turned.forward.point({x, y, height})) < 1e-10);
    }
    const double triangles = static_cast<double>(mesh.triangles.size());
    CHECK(static_cast<double>(geometry.memory().tree) < 25 * triangles);
}

TEST_CASE("damaged meshes are refused") {
    const auto build = [](const MeshModel& mesh) {
        return placed(mesh, Transform{}).build().instance_count();
    };
    MeshModel mesh = two_triangles();
    CHECK(build(mesh) == 1);
    mesh.triangles = changed(mesh.triangles, [](auto& all) { all[1].v[2] = 4; });
    CHECK_THROWS_WITH_AS(build(mesh), "m.rtm: mesh triangle 1: no such vertex", InputError);
    mesh = two_triangles();
    mesh.triangles = changed(mesh.triangles, [](auto& all) { all[0].material = 2; });
    CHECK_THROWS_WITH_AS(build(mesh), "m.rtm: mesh triangle 0: no such material", InputError);
    mesh = two_triangles();
    mesh.normals = changed(mesh.normals, [](auto& all) { all.pop_back(); });
    CHECK_THROWS_WITH_AS(build(mesh), "m.rtm: mesh triangle 1: no such vertex normal", InputError);
    mesh = two_triangles();
    mesh.vs = changed(mesh.vs, [](auto& all) { all.pop_back(); });
    CHECK_THROWS_WITH_AS(build(mesh), "m.rtm: mesh triangle 1: no such texture coordinate",
                         InputError);
    mesh = two_triangles();
    mesh.positions = changed(mesh.positions, [](auto& all) { all[0].x = std::nan(""); });
    CHECK_THROWS_WITH_AS(build(mesh), "m.rtm: mesh triangle 0: vertex out of range", InputError);
}

TEST_CASE("triangles without area and thin ones are never hit by accident") {
    MeshModel mesh;
    mesh.positions = Vertices({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}});
    MeshModel::Triangle line, point;
    line.v[1] = 1, line.v[2] = 2;
    point.v[1] = 3;
    mesh.triangles = Triangles({line, point});
    const TestModels scene = placed(mesh, Transform{});
    const BuiltGeometry geometry = scene.build();
    for (const double x : {0.0, 0.5, 1.0})
        CHECK_FALSE(geometry.intersect({{x, 0, 1}, {0, 0, -1}}).exists());
}
