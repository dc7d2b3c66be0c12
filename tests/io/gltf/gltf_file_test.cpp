#include "io/gltf/gltf_file.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/gltf/gltf_parts.h"
#include "tests/io/gltf/small_gltf.h"

namespace lightwalk {
namespace {

using test::SmallGltf;

GltfFile decode(const std::string& bytes) {
    return decode_gltf(bytes, "x.glb", [](const std::string& path) -> std::string {
        throw InputError({path, 0}, "cannot open");
    });
}

std::string gltf_error(const std::string& bytes) {
    try {
        (void)decode(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool near_vertex(const MeshModel::Vertex& v, double x, double y, double z) {
    return std::abs(v.x - x) < 1e-6 && std::abs(v.y - y) < 1e-6 && std::abs(v.z - z) < 1e-6;
}

/// The text with its first `from` replaced, which must be there.
std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("gltf: y up becomes z up, and v goes up") {
    const GltfFile file = decode(SmallGltf{}.binary());
    REQUIRE(file.parts.size() == 2);
    const MeshModel& mesh = *file.parts[0];
    REQUIRE(mesh.triangles.size() == 2);
    REQUIRE(mesh.positions.size() == 4);
    CHECK(near_vertex(mesh.positions[2], 1, 0, 1));
    CHECK(near_vertex(mesh.normals[0], 0, -1, 0));
    CHECK(mesh.us[1] == 1);
    CHECK(mesh.vs[1] == 0);
    CHECK(mesh.vs[2] == 1);
    CHECK(mesh.triangles[0].has_normals);
    CHECK(file.parts[1]->triangles.empty());
}

TEST_CASE("gltf: nodes transform, by matrices and by scale, rotation, translation") {
    SmallGltf gltf;
    gltf.nodes =
        R"({"children":[1],"translation":[10,0,0]},)"
        R"({"mesh":0,"scale":[2,3,1],"rotation":[0,0.70710678,0,0.70710678],"translation":[0,5,0]})";
    const GltfFile turned = decode(gltf.binary());
    // The corner (1, 1, 0), scaled, turned about y from x to -z, moved.
    CHECK(near_vertex(turned.parts[0]->positions[2], 10, 2, 8));
    CHECK(near_vertex(turned.parts[0]->normals[2], 1, 0, 0));
    gltf.nodes = R"({"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 7,0,0,1]})";
    const GltfFile mirrored = decode(gltf.binary());
    const MeshModel& mesh = *mirrored.parts[0];
    CHECK(near_vertex(mesh.positions[0], 7, 0, 0));
    const auto corner = [&](int i) {
        const MeshModel::Vertex& v = mesh.positions[mesh.triangles[0].v[i]];
        return Vec3{v.x, v.y, v.z};
    };
    const Vec3 facing = cross(corner(1) - corner(0), corner(2) - corner(0));
    CHECK(facing.y < 0);  // still towards its normals
    CHECK(near_vertex(mesh.normals[0], 0, -1, 0));
}

TEST_CASE("gltf: strips and fans have the orientation of triangles") {
    for (const auto& [mode, count] : {std::pair(5, 4), std::pair(6, 4), std::pair(4, 2)}) {
        CAPTURE(mode);
        SmallGltf gltf;
        gltf.meshes = R"({"primitives":[{"attributes":{"POSITION":0},"indices":3,"mode":)" +
                      std::to_string(mode) + "}]}";
        const GltfFile file = decode(gltf.binary());
        const MeshModel& mesh = *file.parts[1];
        CHECK(mesh.normals.empty());
        // 0 1 2, 2 1 0 (strip: turned), 2 0 2 (nothing) ...
        CHECK(mesh.triangles.size() <= static_cast<std::size_t>(count));
        const auto& v = mesh.triangles[0].v;
        const Vec3 a{mesh.positions[v[0]].x, 0, mesh.positions[v[0]].z};
        const Vec3 b{mesh.positions[v[1]].x, 0, mesh.positions[v[1]].z};
        const Vec3 c{mesh.positions[v[2]].x, 0, mesh.positions[v[2]].z};
        CHECK(cross(b - a, c - a).y < 0);
    }
}

TEST_CASE("gltf: sparse accessors replace what they say") {
    SmallGltf gltf;
    gltf.more_accessors =
        R"(,{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,)"
        R"("indices":{"bufferView":3,"byteOffset":2,"componentType":5123},"values":{"bufferView":1}}})";
    gltf.meshes = R"({"primitives":[{"attributes":{"POSITION":4},"indices":3}]})";
    const GltfFile file = decode(gltf.binary());
    const MeshModel& mesh = *file.parts[1];
    CHECK(near_vertex(mesh.positions[0], 0, 0, 0));
    CHECK(near_vertex(mesh.positions[1], 0, -1, 0));  // the normals' values
    CHECK(near_vertex(mesh.positions[2], 0, -1, 0));
    CHECK(near_vertex(mesh.positions[3], 0, 0, 1));
}

TEST_CASE("gltf: what is wrong is told, and nothing is read beyond a buffer") {
    const SmallGltf good;
    const std::string json = good.json(), buffer = good.buffer();
    const auto error = [&](const std::string& from, const std::string& to) {
        return gltf_error(test::glb(with(json, from, to), buffer));
    };
    CHECK(gltf_error(good.binary()) == "");
    CHECK(error("\"count\":6", "\"count\":600") ==
          "x.glb: accessor 3 has 600 elements, which its bufferView of 12 bytes does not hold");
    CHECK(error("\"count\":4", "\"count\":4000000000000000000").find("x.glb: accessor 0 has") == 0);
    CHECK(error("\"POSITION\":0", "\"POSITION\":9") ==
          "x.glb: accessor 9 does not exist, there are 4");
    CHECK(error("\"byteOffset\":128", "\"byteOffset\":1280").find("lies beyond its buffer") !=
          std::string::npos);
    CHECK(error("\"byteOffset\":128", "\"byteOffset\":18446744073709551615")
              .find("lies beyond its buffer") != std::string::npos);
    CHECK(error("\"nodes\":[0]", "\"nodes\":[3]") == "x.glb: node 3 does not exist, there are 1");
    CHECK(error("{\"mesh\":0}", "{\"mesh\":0,\"children\":[0]}") ==
          "x.glb: node 0 is a child twice, or its own ancestor");
    CHECK(error("{\"mesh\":0}", "{\"mesh\":5}") == "x.glb: mesh 5 does not exist, there are 1");
    CHECK(error("\"material\":0", "\"material\":4") ==
          "x.glb: material 4 does not exist, there are 1");
    CHECK(error("\"scene\":0", "\"scene\":4") == "x.glb: scene 4 does not exist, there are 1");
    CHECK(error("\"asset\"", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\"") ==
          "x.glb: requires the extension KHR_draco_mesh_compression, which is not supported");
    CHECK(
        error("{\"name\":\"m\"}", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":2}}})") ==
        "x.glb: texture 2 does not exist, there are 0");
    CHECK(error("\"asset\"", "\"extras\":" + std::string(1000, '[') + std::string(1000, ']') +
                                 ",\"asset\"") == "x.glb: its JSON nests more than 64 levels deep");
}

TEST_CASE("gltf: numbers that are none, and indices beyond the vertices") {
    const SmallGltf good;
    std::string buffer = good.buffer();
    const float nan = std::nanf("");
    std::memcpy(buffer.data() + 12, &nan, sizeof nan);
    CHECK(gltf_error(test::glb(good.json(), buffer))
              .find("x.glb: accessor 0 holds what is no finite number") == 0);
    buffer = good.buffer();
    buffer[128] = 77;
    CHECK(gltf_error(test::glb(good.json(), buffer)) == "x.glb: index 77 of a mesh of 4 vertices");
    CHECK(gltf_error(with(good.binary(), "JSON", "JSOM")).find("x.glb: ") == 0);
    const std::string whole = good.binary();
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        CAPTURE(size);
        CHECK(gltf_error(whole.substr(0, size)).find("x.glb: ") == 0);
    }
}

TEST_CASE("gltf: only files beside are asked for") {
    const SmallGltf good;
    const auto error = [&](const std::string& uri) { return gltf_error(good.json(uri)); };
    CHECK(error("a.bin") == "x.glb: a.bin: cannot open");
    for (const char* uri : {"/etc/passwd", "../a.bin", "b/../../a.bin", "file:///etc/passwd",
                            "http://x/a.bin", "b\\\\a.bin", "%2e%2e/a.bin"}) {
        CAPTURE(uri);
        CHECK(error(uri).find("which is not a file beside it or below") != std::string::npos);
    }
    std::string asked;
    const GltfFile file =
        decode_gltf(good.json("b/my%20a.bin"), "x.gltf", [&](const std::string& path) {
            asked = path;
            return good.buffer();
        });
    CHECK(asked == "b/my a.bin");
    CHECK(file.parts[0]->triangles.size() == 2);
    CHECK(error("data:application/octet-stream;base64,AAAA").find("x.glb: ") == 0);
}

TEST_CASE("gltf: repeated meshes have an end") {
    SmallGltf gltf;
    gltf.nodes = R"({"mesh":0},{"mesh":0},{"mesh":0})";
    gltf.roots = "0,1,2";
    const tinygltf::Model model =
        load_gltf(gltf.binary(), "x.glb", [](const std::string&) { return std::string(); });
    const auto surfaces = gltf_surfaces(model, "x.glb");
    GltfFile file;
    CHECK_THROWS_WITH_AS(add_gltf_nodes(model, surfaces, "x.glb", 5, file),
                         "x.glb: its nodes repeat meshes to too many triangles", InputError);
    add_gltf_nodes(model, surfaces, "x.glb", 9, file);
    CHECK(file.parts[0]->triangles.size() == 6);
}

TEST_CASE("gltf: materials, their names and extensions") {
    SmallGltf gltf;
    gltf.materials =
        R"({"name":"my wall","emissiveFactor":[1,2,0.5],"alphaMode":"MASK","alphaCutoff":0.25,)"
        R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5},)"
        R"("extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":100},)"
        R"("KHR_materials_ior":{"ior":1.6},"KHR_materials_transmission":{"transmissionFactor":0.7}}},)"
        R"({"name":"my wall"},{},{"name":"void"},{"name":"#\n\""})";
    const auto materials = decode(gltf.binary()).materials;
    REQUIRE(materials.size() == 5);
    CHECK(materials[0].name == "my_wall");
    CHECK(materials[1].name == "my_wall.1");
    CHECK(materials[2].name == "material_2");
    CHECK(materials[3].name == "material_3");
    CHECK(materials[4].name == "___");
    CHECK(materials[0].emitted == GltfMaterial::Color{100, 200, 50});
    CHECK(materials[0].base == GltfMaterial::Color{0.1, 0.2, 0.3});
    CHECK(materials[0].opacity == 0.4);
    CHECK(materials[0].alpha == GltfMaterial::Alpha::mask);
    CHECK(materials[0].cutoff == 0.25);
    CHECK(materials[0].ior == 1.6);
    CHECK(materials[0].transmission == 0.7);
    CHECK(materials[1].metallic == 1);
}

}  // namespace lightwalk
