#include "io/scene/obj_scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "tests/folder_scene.h"
#include "tests/io/generators/generated.h"

namespace lightwalk {
namespace {

using test::FolderScene;

constexpr const char* kRoof =
    "# a roof of two faces, and a wall\nv 0 0 0\nv 2 0 0\nv 2 1 1\nv 0 1 .8\nv 2 2 0\nv 0 2 .1\n"
    "vt 0 0\nvt 1 0\nvt 1 .5\nvt 0 .5\nvn 0 -.8 1\nvn 0 0 1\nvn .2 .8 1\nusemtl tiles\n"
    "f 1/1/1 2/2/1 3/3/2 4/4/2\nusemtl slate\nf -3//2 -2//3 -1//3 4//2\n"
    "usemtl plaster\nf 1 2 -2 -1\n";

constexpr const char* kRoofMaterials =
    "void brightfunc stripes 2 1+2*Lu+5*Lv . 0 0\nstripes glow tiles 0 0 4 1 1 1 0\n"
    "void plastic slate 0 0 5 .5 .4 .3 0 0\nvoid plastic plaster 0 0 5 .8 .8 .8 0 0\n"
    "void light sun 0 0 3 100000 100000 100000\nsun source sky 0 0 4 .3 .2 1 .5\n";

const std::vector<std::array<double, 6>> kRaysAtRoof = {
    {.3, .4, 3, 0, 0, -1},   {1.8, .3, 3, 0, 0, -1}, {.9, .9, 3, 0, 0, -1},
    {1.1, 1.3, 3, 0, 0, -1}, {.2, 1.9, 3, 0, 0, -1}, {1.7, 1.1, 3, 0, 0, -1}};

void check_red(FolderScene& scene, const std::vector<double>& expected, double tolerance = 2e-5) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        // A compiled mesh has normals of 31 bits, which differ by up to 1e-5.
        CHECK(static_cast<double>(scene.value(kRaysAtRoof[i]).r) ==
              doctest::Approx(expected[i]).epsilon(tolerance));
    }
}

// What Radiance's rtrace says of the mesh that obj2mesh makes of it, and of obj2rad's polygons.
const std::vector<double> kMeshRed = {2.3, 3.55, 4.15, 1.45247, 0.866155, 1.45247};
const std::vector<double> kMirroredRed = {1.190075, 1.157837, 1.408316,
                                          .2929978, 2.152270, .2929978};
const std::vector<double> kPolygonRed = {1, 1, 1, 1.43637, 0.866147, 1.4328};

}  // namespace

TEST_CASE("an object file named as a scene is the mesh that obj2mesh makes of it") {
    const test::TemporaryFolder folder;
    folder.write("sub/x.obj", kRoof);
    folder.write("materials.rad", kRoofMaterials);
    FolderScene scene(folder, {"materials.rad", "sub/x.obj"});
    check_red(scene, kMeshRed);
}

TEST_CASE("meshes of object files mirror as the reference's do: smoothed metal, mirrors, lobes") {
    // Without random lobes (-ss 0). Values of rtrace 6.0a, for what obj2mesh made.
    const test::TemporaryFolder folder;
    folder.write("x.obj", kRoof);
    folder.write("materials.rad",
                 "void metal tiles 0 0 5 .8 .6 .3 .9 .05\nvoid mirror slate 0 0 3 .8 .8 .8\n"
                 "void plastic plaster 0 0 5 .5 .5 .5 .1 .05\n"
                 "void brightfunc dirs 2 2+Dx+.5*Dy . 0 0\ndirs glow sky 0 0 4 1 1 1 0\n"
                 "sky source s 0 0 4 0 0 1 360\nvoid light sun 0 0 3 10000 10000 10000\n"
                 "sun source s 0 0 4 .3 .2 1 .5\n");
    RenderOptions options = test::TestScene::exact();
    options.specular_threshold = 0;
    FolderScene scene(folder, {"materials.rad", "x.obj"}, options);
    check_red(scene, kMirroredRed, 1e-4);
}

TEST_CASE("!obj2rad makes the polygons that obj2rad makes") {
    const test::TemporaryFolder folder;
    folder.write("x.obj", kRoof);
    folder.write("room.rad", std::string(kRoofMaterials) + "!obj2rad x.obj\n");
    FolderScene scene(folder, {"room.rad"});
    check_red(scene, kPolygonRed);
}

TEST_CASE("obj2rad: names, materials and textures") {
    const test::GeneratorInput input{
        "",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 .2\nv 2 1 -.3\nvn 0 0 1\nvn .5 0 1\nvn 0 .5 1\n"
        "f 1 2 3\ng grp\nf 1 2 3 4\nusemtl red\nf 1 2 6 4\no obj\nf 1//1 2//2 3//3\n"
        "f 1//1 2//1 3//1\n"};
    const auto generated = test::generate("obj2rad", input);
    CHECK(test::names(generated) == std::vector<std::string>{"unnamed.1", "grp.2", "grp.3", "grp.3",
                                                             "Phong", "obj.4", "obj.5"});
    const auto& p = generated.primitives;
    CHECK(p[0].modifier == "white");
    CHECK(p[1].modifier == "grp");
    CHECK(p[1].reals.size() == 12);
    CHECK(p[2].reals == std::vector<double>{0, 0, 0, 1, 0, 0, 2, 1, -.3});  // it is not flat
    CHECK(p[3].reals == std::vector<double>{0, 0, 0, 2, 1, -.3, 0, 1, 0});
    CHECK(p[4].strings == std::vector<std::string>{"dx", "dy", "dz", "tmesh.cal"});
    const std::vector<double> expected = {2,          0.44721360, -0.44721360, 0, 0,
                                          0.44721360, 0,          -0.10557281, 0, 1};  // Radiance's
    REQUIRE(p[4].reals.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(std::abs(p[4].reals[i] - expected[i]) < 1e-8);
    CHECK(p[5].modifier == "Phong");
    CHECK(p[6].modifier == "red");  // whose normals are the plane's
    CHECK(test::names(test::generate("obj2rad -f -o thing", input)) ==
          std::vector<std::string>{"thing.1", "grp.2", "grp.3", "grp.3", "obj.4", "obj.5"});
    const test::TemporaryFolder folder;
    folder.write("a.map",
                 "wood (Face [2:4]);\nvoid (Material \"red\") ;\nroof (Object \"obj\");\n");
    CHECK(test::names(test::generate("obj2rad -m a.map", {folder.path(), input.text})) ==
          std::vector<std::string>{"grp.2", "Phong", "obj.4", "obj.5"});
    test::Silence silence;
    CHECK(test::generate_text("obj2rad -n", input, silence).find("\"red\"") != std::string::npos);
    CHECK(test::generator_error("obj2rad -x", input).find("unknown option") != std::string::npos);
    CHECK(test::generator_error("obj2rad a.obj b.obj", input) != "");
}

TEST_CASE("a material of an object file is the scene's, or else its library's, or white") {
    const test::TemporaryFolder folder;
    folder.write("m/lib.mtl",
                 "newmtl slate\nKe 7 7 7\nnewmtl plaster\nKe 5 5 5\nnewmtl pict\nKd 1 1 1\n"
                 "map_Kd p.hdr\nnewmtl leaf\nKd 0 0 0\nmap_d p.hdr\n");
    folder.write("m/p.hdr", encode_hdr({1, 1, {Rgb::grey(0.5f)}}, {}));
    const std::string square =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nmtllib lib.mtl\n";
    const auto value = [&](const std::string& faces, const std::string& before) {
        folder.write("m/x.obj", square + faces);
        folder.write("before.rad",
                     "void glow all 0 0 4 1 1 1 0\nall source s 0 0 4 0 0 1 360\n" + before);
        RenderOptions options = test::TestScene::exact();
        options.ambient_value = {1, 1, 1};
        FolderScene scene(folder, {"before.rad", "m/x.obj"}, options);
        return static_cast<double>(scene.value({.4, .3, 1, 0, 0, -1}).r);
    };
    CHECK(value("usemtl slate\nf 1 2 3 4\n", "") == doctest::Approx(7));
    CHECK(value("usemtl slate\nf 1 2 3 4\n", "void glow slate 0 0 4 2 2 2 0\n") ==
          doctest::Approx(2));
    CHECK(value("g plaster\nf 1 2 3 4\n", "") == doctest::Approx(5));
    CHECK(value("g unknown\nf 1 2 3 4\n", "") == doctest::Approx(.5));
    CHECK(value("usemtl leaf\nf 1/1 2/1 3/2 4/2\n", "") == doctest::Approx(.5).epsilon(.01));
    CHECK(value("f 1 2 3 4\n", "void glow white 0 0 4 3 3 3 0\n") == doctest::Approx(3));
    CHECK(value("usemtl pict\nf 1/1 2/1 3/2 4/2\n", "") == doctest::Approx(.5).epsilon(1.0 / 128));
    CHECK_THROWS_WITH_AS(value("\nusemtl gone\nf 1 2 3 4\n", ""),
                         (folder.path("m/x.obj") +
                          ":10: undefined material \"gone\": neither a scene file before it nor "
                          "its mtllib defines it")
                             .c_str(),
                         InputError);
}

TEST_CASE("a mesh primitive may name an object file, with the materials of its library") {
    const test::TemporaryFolder folder;
    folder.write("x.mtl", "newmtl a\nKe 4 4 4\nnewmtl b\nKe 6 6 6\n");
    folder.write("x.obj",
                 "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                 "usemtl a\nf 1 2 3 4\nusemtl b\nf 2 5 6 3\n");
    folder.write("room.rad",
                 "void mesh m 5 x.obj -t 0 10 0 0 0\nvoid glow own 0 0 4 9 9 9 0\n"
                 "own mesh n 1 ./x.obj 0 0\nown mesh o 5 x.obj#b -t 0 20 0 0 0\n");
    FolderScene scene(folder, {"room.rad"});
    const auto at = [&](double x, double y) {
        return static_cast<double>(scene.value({x, y, 1, 0, 0, -1}).r);
    };
    CHECK(at(.5, 10.5) == doctest::Approx(4));
    CHECK(at(1.5, 10.5) == doctest::Approx(6));
    CHECK(at(.5, .5) == doctest::Approx(9));
    CHECK(at(1.5, 20.5) == doctest::Approx(9));
    CHECK(at(.5, 20.5) == 0);
}

TEST_CASE("obj: parts are told from files by the ending") {
    CHECK_FALSE(obj_name("a.rtm"));
    CHECK_FALSE(obj_name("a.obj.rtm"));
    CHECK(obj_name("a#b/c.OBJ")->file == "a#b/c.OBJ");
    CHECK(obj_name("a.obj#b#c")->material == "b#c");
    CHECK(obj_name("a.obj#")->material == "");
}

}  // namespace lightwalk
