#include "io/wavefront/obj_file.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/wavefront/obj_mesh.h"

namespace lightwalk {
namespace {

std::string obj_error(const std::string& text) {
    try {
        (void)decode_obj(text, "x.obj");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// A polygon with these corners in a tilted plane.
ObjFile polygon(const std::vector<std::array<double, 2>>& corners) {
    std::string text;
    for (const auto& [x, y] : corners)
        text += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
                std::to_string(0.5 * x - 0.25 * y) + "\n";
    text += "f";
    for (std::size_t i = 1; i <= corners.size(); ++i) text += " " + std::to_string(i);
    return decode_obj(text, "x.obj");
}

ObjFile regular(std::size_t n, double inner = 1) {
    std::vector<std::array<double, 2>> corners;
    for (std::size_t i = 0; i < n; ++i) {
        const double phi = 2 * kPi * static_cast<double>(i) / static_cast<double>(n);
        const double r = i % 2 == 0 ? 1 : inner;
        corners.push_back({r * std::cos(phi), r * std::sin(phi)});
    }
    return polygon(corners);
}

std::set<ObjTriangle> sorted_triangles(const ObjFile& file, std::size_t first) {
    std::set<ObjTriangle> result;
    for (ObjTriangle triangle : triangulate(file, file.faces.at(0), first)) {
        std::ranges::sort(triangle);
        result.insert(triangle);
    }
    return result;
}

Vec3 area_of(const ObjFile& file, const ObjTriangle& t) {
    const auto& p = file.positions;
    return 0.5 * cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
}

}  // namespace

TEST_CASE("obj: faces refer to vertices, texture coordinates and normals, forward and back") {
    const ObjFile file = decode_obj(
        "# comment\nmtllib a.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0\nvt .5 .25 0\nvn 0 0 2\n"
        "f 1 2 3\ng one two\nf 1/1/1 2//1 -1/1\nusemtl red paint\nusemtl\no thing\nf 1 2 \\\n3 # "
        "a\n"
        "s 1\nfoo bar\n",
        "x.obj");
    REQUIRE(file.faces.size() == 3);
    CHECK(file.libraries == std::vector<std::string>{"a.mtl"});
    CHECK(file.normals.at(0) == Vec3{0, 0, 1});
    using Corner = ObjFile::Corner;
    CHECK(file.corners_of(file.faces[1])[0] == Corner{0, 0, 0});
    CHECK(file.corners_of(file.faces[1])[1] == Corner{1, ObjFile::kNone, 0});
    CHECK(file.corners_of(file.faces[1])[2] == Corner{2, 0, ObjFile::kNone});
    CHECK(file.material_of(file.faces[0]) == "");
    CHECK(file.material_of(file.faces[1]) == "one");
    CHECK(file.material_of(file.faces[2]) == "red paint");
    CHECK(file.names[file.faces[2].object] == "thing");
    CHECK(file.faces[2].count == 3);
    CHECK(file.faces[2].line == 14);
}

TEST_CASE("obj: what is wrong is said with its line") {
    CHECK(obj_error("v 0 0\n") == "x.obj:1: bad number \"\" of a vertex");
    CHECK(obj_error("\nv 0 x 0\n") == "x.obj:2: bad number \"x\" of a vertex");
    CHECK(obj_error("vn 0 0 0\n") == "x.obj:1: a normal of no length");
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    CHECK(obj_error(three + "f 1 2\n") == "x.obj:4: a face of 2 vertices, expected at least 3");
    CHECK(obj_error(three + "f 1 2 4\n") ==
          "x.obj:4: corner \"4\" of a face: there is no vertex 4, there are 3");
    CHECK(obj_error(three + "f -1 -2 -4\n").find("there is no vertex -4") != std::string::npos);
    CHECK(obj_error(three + "f 1/1 2 3\n").find("no texture coordinate 1") != std::string::npos);
    for (const char* corner : {"0", "1/2/3/4", "x", "1.5", "/1"})
        CHECK(obj_error(three + "f 1 2 " + corner + "\n").find("x.obj:4: ") == 0);
}

TEST_CASE("obj: convex faces are divided as Radiance divides them") {
    using Set = std::set<ObjTriangle>;
    CHECK(sorted_triangles(regular(4), 0) == Set{{0, 1, 3}, {1, 2, 3}});
    CHECK(sorted_triangles(regular(5), 0) == Set{{0, 1, 4}, {1, 2, 3}, {1, 3, 4}});
    CHECK(sorted_triangles(regular(6), 0) == Set{{0, 1, 5}, {1, 2, 3}, {3, 4, 5}, {1, 3, 5}});
    CHECK(sorted_triangles(regular(8), 0) ==
          Set{{0, 1, 7}, {1, 2, 3}, {3, 4, 5}, {5, 6, 7}, {1, 3, 7}, {3, 5, 7}});
    CHECK(sorted_triangles(regular(4), 1) == Set{{0, 1, 2}, {0, 2, 3}});
    CHECK(sorted_triangles(regular(5), 1) == Set{{0, 1, 2}, {2, 3, 4}, {0, 2, 4}});
}

TEST_CASE("obj: the triangles of a concave face cover it, and nothing else") {
    for (const ObjFile& file :
         {regular(14, 0.2), regular(5),
          polygon({{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}})}) {
        Vec3 whole;  // Newell's area of the polygon
        const auto& p = file.positions;
        for (std::size_t i = 0; i < p.size(); ++i)
            whole += 0.5 * cross(p[i], p[(i + 1) % p.size()]);
        for (const std::size_t first : {0u, 1u}) {
            double covered = 0;
            for (const ObjTriangle& triangle : triangulate(file, file.faces[0], first)) {
                const Vec3 area = area_of(file, triangle);
                CHECK(dot(area, whole) > 0);
                covered += length(area);
            }
            CHECK(covered == doctest::Approx(length(whole)).epsilon(1e-6));  // six decimals
        }
    }
}

TEST_CASE("obj: faces that cross themselves, lie in a line or have no area do no harm") {
    CHECK(triangulate(polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), {0, 4}, 0).size() <= 2);
    CHECK(triangulate(polygon({{0, 0}, {1, 0}, {2, 0}, {3, 0}}), {0, 4}, 0).empty());
    CHECK(triangulate(polygon({{1, 1}, {1, 1}, {1, 1}}), {0, 3}, 0).empty());
}

TEST_CASE("obj: a mesh shares corners that are equal, and is smooth where all have normals") {
    const ObjFile file = decode_obj(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nusemtl a\n"
        "f 1/1/1 2/2/1 3/1/1\nusemtl b\nf 1/1/1 3/1/1 4/1\nf 1 3 4\n",
        "x.obj");
    Model materials;
    materials.modifiers.resize(1);
    materials.modifiers[0].name = "b";
    const MeshModel all = mesh_of_obj(file, std::nullopt, std::move(materials));
    REQUIRE(all.triangles.size() == 3);
    CHECK(all.positions.size() == 7);  // 3 and 1, and 3 without anything
    CHECK(all.triangles[0].material == kVoidIndex);
    CHECK(all.triangles[1].material == 0);
    CHECK(all.triangles[0].has_normals);
    CHECK_FALSE(all.triangles[1].has_normals);
    CHECK(all.triangles[1].has_uvs);
    CHECK_FALSE(all.triangles[2].has_uvs);
    CHECK(all.normals.size() == all.positions.size());
    CHECK(mesh_of_obj(file, "b", {}).triangles.size() == 2);
    CHECK(mesh_of_obj(file, "c", {}).triangles.empty());
}

}  // namespace lightwalk
