#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/math/direction_code.h"
#include "core/math/vec3.h"
#include "io/scene/binary_models.h"
#include "tests/io/scene/binary_writer.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::BinaryWriter;
using test::kFewRoundings;
using test::rounded;
using test::within;

constexpr double kStep = 4.5 / 4294967296.0;

struct MeshFile {
    bool materials = true;
    int patches = 3;
    int joiner_corner = 256;  ///< first corner of the single joiner in patch 0
    int local_material = 1;   ///< of patch 2's only triangle
    double u_max = 2;
};

void add_vertices(BinaryWriter& file, int count, std::uint32_t code) {
    for (int i = 0; i < 3 * count; ++i)
        file.integer(code + static_cast<std::uint32_t>(i) * 1000, 4);
}

/// Patch 0: normals but one, two local triangles of different materials, a single and a double
/// joiner to later patches. Patch 1: bare. Patch 2: normals and (u, v), one triangle.
std::string mesh_bytes(const MeshFile& m = {}) {
    BinaryWriter file = test::begin_file("Radiance_tmesh", 323);
    file.real(1).real(m.u_max).real(-1).real(1);
    file.integer(0, 1);
    if (m.materials) {
        file.text("plastic").text("");
        for (const char* name : {"red", "blue"}) {
            file.integer(0, 1).integer(-1, 4).text(name).integer(0, 2).integer(0, 2);
        }
    } else {
        file.text("");
    }
    file.integer(-1, 1).integer(m.patches, 4);

    file.integer(1 | 2, 1).integer(4, 2);
    add_vertices(file, 4, 0);
    for (int i = 0; i < 4; ++i) file.integer(i == 3 ? 0 : encode_direction({0, 0, 1}), 4);
    file.integer(2, 2)
        .raw(std::string("\0\1\2\1\2\3", 6))
        .integer(2, 2)
        .integer(0, 2)
        .integer(1, 2);
    file.integer(1, 2).integer(m.joiner_corner, 4).raw(std::string("\0\1", 2)).integer(0, 2);
    file.integer(1, 2).integer(512, 4).integer(513, 4).raw(std::string("\2", 1)).integer(1, 2);

    file.integer(1, 1).integer(1, 2);
    add_vertices(file, 1, 0x80000000U);
    file.integer(0, 2).integer(1, 2).integer(0, 2).integer(0, 2).integer(0, 2);

    file.integer(1 | 2 | 4, 1).integer(3, 2);
    add_vertices(file, 3, 0xffff0000U);
    for (int i = 0; i < 3; ++i) file.integer(encode_direction({0, -1, 0}), 4);
    for (int i = 0; i < 3; ++i) file.integer(0x40000000, 4).integer(0x80000000LL, 4);
    file.integer(1, 2).raw(std::string("\0\2\1", 3)).integer(1, 2).integer(m.local_material, 2);
    file.integer(0, 2).integer(0, 2);
    return file.bytes();
}

std::string message_of(const std::string& bytes) {
    try {
        static_cast<void>(decode_mesh(bytes, "x.rtm"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST_CASE("triangles come patch by patch: local ones, single joiners, double joiners") {
    const MeshModel mesh = decode_mesh(mesh_bytes(), "x.rtm");
    REQUIRE(mesh.triangles.size() == 5);
    const std::uint32_t corners[5][3] = {{0, 1, 2}, {1, 2, 3}, {4, 0, 1}, {5, 6, 2}, {5, 7, 6}};
    const std::int32_t materials[5] = {0, 1, 0, 1, 1};
    for (std::size_t t = 0; t < 5; ++t) {
        CAPTURE(t);
        for (std::size_t k = 0; k < 3; ++k) CHECK(mesh.triangles[t].v[k] == corners[t][k]);
        CHECK(mesh.triangles[t].material == materials[t]);
    }
    CHECK(mesh.materials.modifiers[1].name == "blue");
}

TEST_CASE(
    "positions lie in the middle of their cells, (u, v) in their range, normals are decoded") {
    const MeshModel mesh = decode_mesh(mesh_bytes(), "x.rtm");
    REQUIRE(mesh.positions.size() == 8);
    CHECK(mesh.positions[0].x == within(kFewRoundings, -1 + 0.5 * kStep));
    CHECK(mesh.positions[1].z == within(kFewRoundings, -3 + 5000.5 * kStep));
    CHECK(mesh.positions[4].x == within(kStep, -1 + 2.25));
    CHECK(mesh.normals.size() == 8);
    CHECK(mesh.normals[0].z == 1);
    CHECK(mesh.normals[5].y == -1);
    CHECK(mesh.us[5] == within(0x1p-31, 1.25));
    CHECK(mesh.vs[5] == within(0x1p-31, 0));
}

TEST_CASE("normals and (u, v) count only where all three corners have them") {
    const MeshModel mesh = decode_mesh(mesh_bytes(), "x.rtm");
    const bool normals[5] = {true, false, false, true, true};
    const bool uvs[5] = {false, false, false, false, true};
    for (std::size_t t = 0; t < 5; ++t) {
        CAPTURE(t);
        CHECK(mesh.triangles[t].has_normals == normals[t]);
        CHECK(mesh.triangles[t].has_uvs == uvs[t]);
    }
}

TEST_CASE("without materials triangles have none") {
    const MeshModel mesh = decode_mesh(mesh_bytes({.materials = false}), "x.rtm");
    for (const MeshModel::Triangle& triangle : mesh.triangles)
        CHECK(triangle.material == kVoidIndex);
}

TEST_CASE("bad meshes are refused with a reason") {
    CHECK(message_of(test::begin_file("Radiance_tmesh", 318).bytes()) ==
          "x.rtm: incompatible mesh format");
    CHECK(message_of(mesh_bytes({.patches = -1})) == "x.rtm: negative number of patches");
    CHECK(message_of(mesh_bytes({.patches = 4})) == "x.rtm: truncated mesh");
    CHECK(message_of(mesh_bytes({.patches = 2})) == "x.rtm: triangle corner 512 does not exist");
    CHECK(message_of(mesh_bytes({.joiner_corner = 257})) ==
          "x.rtm: triangle corner 257 does not exist");
    CHECK(message_of(mesh_bytes({.local_material = 2})) == "x.rtm: bad triangle material 2");
    CHECK(message_of(mesh_bytes({.local_material = -1})) == "x.rtm: bad triangle material -1");
    CHECK(message_of(mesh_bytes({.u_max = 1})) == "x.rtm: texture coordinates with an empty range");
    CHECK(message_of(BinaryWriter()
                         .raw("#?x\n\n")
                         .integer(323, 2)
                         .text("0")
                         .text("0")
                         .text("0")
                         .text("0")
                         .bytes()) == "x.rtm: illegal bounds in mesh");
    CHECK(
        message_of(BinaryWriter().raw("#?x\n\n").integer(323, 2).text("0").text("zero").bytes()) ==
        "x.rtm: bad bounding cube: \"zero\" is no number");
    BinaryWriter surface = test::begin_file("Radiance_tmesh", 323);
    surface.real(0).real(0).real(0).real(0).integer(0, 1).text("sphere").text("");
    surface.integer(0, 1).integer(-1, 4).text("s").integer(0, 2).integer(0, 2).integer(-1, 1);
    CHECK(message_of(surface.bytes()) == "x.rtm: non-modifier \"s\" in mesh");
}

TEST_CASE("every truncation of a mesh is an error") {
    const std::string whole = mesh_bytes();
    CHECK(message_of(whole) == "no error");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        CAPTURE(size);
        CHECK(message_of(whole.substr(0, size)).starts_with("x.rtm: "));
    }
}

}  // namespace
}  // namespace lightwalk
