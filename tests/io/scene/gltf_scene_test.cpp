#include "io/scene/gltf_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "io/files/watched_files.h"
#include "tests/folder_scene.h"
#include "tests/io/gltf/small_gltf.h"
#include "tests/io/picture/small_images.h"

namespace lightwalk {
namespace {

using test::FolderScene;
using test::SmallGltf;

constexpr const char* kWhiteSky = "void glow all 0 0 4 1 1 1 0\nall source s 0 0 4 0 0 1 360\n";

/// Diffuse, of a colour or with more members.
std::string diffuse(const std::string& color, const std::string& more = "") {
    return R"({"name":"m","pbrMetallicRoughness":{"baseColorFactor":)" + color +
           R"(,"metallicFactor":0)" + more + R"(},"extensions":{"KHR_materials_unlit":{}}})";
}

/// In light of 1 from all around, which a diffuse surface reflects by its colour.
RenderOptions all_around() {
    RenderOptions options = test::TestScene::exact();
    options.ambient_value = {1, 1, 1};
    return options;
}

double red(FolderScene& scene, double x, double z, double y = -1) {
    return static_cast<double>(scene.value({x, y, z, 0, 1, 0}).r);
}

}  // namespace

TEST_CASE("a glTF file named as a scene is meshes of its materials") {
    const test::TemporaryFolder folder;
    SmallGltf gltf;
    gltf.materials = diffuse("[0.25,0.5,0.75,1]");
    folder.write("a/x.glb", gltf.binary());
    folder.write("sky.rad", kWhiteSky);
    folder.write("own.rad", "void glow m 0 0 4 3 3 3 0\n");
    FolderScene scene(folder, {"a/x.glb", "sky.rad"}, all_around());
    const Rgb color = scene.value({.4, -1, .3, 0, 1, 0});
    CHECK(static_cast<double>(color.r) == doctest::Approx(.25));
    CHECK(static_cast<double>(color.b) == doctest::Approx(.75));
    CHECK(red(scene, 1.5, .5) == doctest::Approx(1));
    FolderScene owned(folder, {"own.rad", "a/x.glb"}, all_around());
    CHECK(red(owned, .5, .5) == doctest::Approx(3));
}

TEST_CASE("glTF files of the same names have materials of their own") {
    const test::TemporaryFolder folder;
    SmallGltf one, two;
    one.materials = diffuse("[0.25,0.5,0.75,1]");
    two.materials = diffuse("[0.5,0.5,0.75,1]");
    two.nodes = R"({"mesh":0,"translation":[2,0,0]})";
    folder.write("x.glb", one.binary());
    folder.write("y.glb", two.binary());
    folder.write("sky.rad", kWhiteSky);
    FolderScene scene(folder, {"x.glb", "y.glb", "sky.rad"}, all_around());
    CHECK(red(scene, .5, .5) == doctest::Approx(.25));
    CHECK(red(scene, 2.5, .5) == doctest::Approx(.5));
}

TEST_CASE("a glTF file's texture colours, and its alpha cuts") {
    const test::TemporaryFolder folder;
    SmallGltf gltf;
    gltf.image = test::small_png();
    gltf.materials = diffuse("[0.5,1,1,1]", R"(,"baseColorTexture":{"index":0})");
    gltf.materials.insert(1, R"("alphaMode":"MASK",)");
    folder.write("x.glb", gltf.binary());
    folder.write("sky.rad", kWhiteSky);
    FolderScene scene(folder, {"x.glb", "sky.rad"}, all_around());
    constexpr double kIn = 1e-4;
    CHECK(red(scene, kIn, 1 - kIn) == doctest::Approx(.5).epsilon(1e-3));
    CHECK(red(scene, 1 - kIn, 1 - kIn) == doctest::Approx(0).epsilon(1e-3));
    CHECK(red(scene, 1 - kIn, kIn) == doctest::Approx(1));  // behind the transparent corner
    SUBCASE("and beside it") {
        SmallGltf outside = gltf;
        std::string json = outside.json("my.bin");
        const std::string inside = R"("bufferView":4,"mimeType":"image/png")";
        json.replace(json.find(inside), inside.size(), R"("uri":"my%20picture.png")");
        folder.write("z/x.gltf", json);
        folder.write("z/my.bin", outside.buffer());
        folder.write("z/my picture.png", gltf.image);
        FolderScene other(folder, {"z/x.gltf", "sky.rad"}, all_around());
        for (const auto& [x, z] : {std::pair(.1, .9), std::pair(.4, .3), std::pair(.9, .1)})
            CHECK(red(other, x, z) == red(scene, x, z));
    }
}

TEST_CASE("a glTF file's texture may be WebP, by an extension that others may leave out") {
    const test::TemporaryFolder folder;
    SmallGltf gltf;
    gltf.image = test::small_webp();
    gltf.materials = diffuse("[1,1,1,1]", R"(,"baseColorTexture":{"index":0})");
    std::string json = gltf.json();
    const std::string plain = R"("textures":[{"source":0})";
    const auto at = json.find(plain);
    REQUIRE(at != std::string::npos);
    json.replace(at, plain.size(),
                 R"("textures":[{"extensions":{"EXT_texture_webp":{"source":0}}})");
    json.insert(1, R"("extensionsRequired":["EXT_texture_webp"],)");
    folder.write("x.glb", test::glb(json, gltf.buffer()));
    folder.write("sky.rad", kWhiteSky);
    FolderScene scene(folder, {"x.glb", "sky.rad"}, all_around());
    CHECK(red(scene, .5, .5) == doctest::Approx(.956).epsilon(.02));  // 250 of 255 in sRGB
}

TEST_CASE("glTF: emission of few triangles is a light, of its luminance") {
    const test::TemporaryFolder folder;
    SmallGltf gltf;
    gltf.materials =
        R"({"name":"lamp","emissiveFactor":[1,1,1],)"
        R"("extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":358}}})";
    folder.write("x.glb", gltf.binary());
    folder.write("floor.rad",
                 "void plastic w 0 0 5 .5 .5 .5 0 0\n"
                 "w polygon f 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n");
    FolderScene scene(folder, {"x.glb", "floor.rad"});
    CHECK(red(scene, .5, .5) == doctest::Approx(2));
    CHECK(static_cast<double>(scene.value({.5, -1, 1, 0, 0, -1}).r) > 0.01);
}

TEST_CASE("glTF files in mesh primitives and behind xform") {
    const test::TemporaryFolder folder;
    SmallGltf gltf;
    gltf.materials = diffuse("[0.25,0.5,0.75,1]");
    folder.write("a/x.glb", gltf.binary());
    folder.write("sky.rad", kWhiteSky);
    folder.write("room.rad",
                 "void mesh whole 5 a/x.glb -t 0 0 10 0 0\nvoid glow own 0 0 4 7 7 7 0\n"
                 "own mesh part 5 ./a/x.glb#0 -t 0 0 20 0 0\n!xform -t 0 0 30 a/x.glb\n"
                 "!xform -n n -t 0 0 40 b/y.obj\n");
    folder.write("b/y.obj", "mtllib y.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nusemtl a\nf 1 2 3\n");
    folder.write("b/y.mtl", "newmtl a\nKe 4 4 4\n");
    FolderScene scene(folder, {"room.rad", "sky.rad"}, all_around());
    CHECK(red(scene, .6, 10.5) == doctest::Approx(.25));
    CHECK(red(scene, .6, 20.5) == doctest::Approx(7));
    CHECK(red(scene, .6, 30.5) == doctest::Approx(.25));
    CHECK(red(scene, .6, 40.5) == doctest::Approx(4));
}

TEST_CASE("what is wrong with a glTF file ends the reading, a missing picture does not") {
    const test::TemporaryFolder folder;
    folder.write("bad.glb", "glTF nonsense that is long enough");
    CHECK_THROWS_WITH_AS(FolderScene(folder, {"bad.glb"}), doctest::Contains("bad.glb: "),
                         InputError);
    SmallGltf gltf;
    gltf.image = "no picture";
    gltf.materials = diffuse("[0.5,1,1,1]", R"(,"baseColorTexture":{"index":0})");
    folder.write("x.glb", gltf.binary());
    folder.write("sky.rad", kWhiteSky);
    FolderScene scene(folder, {"x.glb", "sky.rad"}, all_around());
    CHECK(red(scene, .5, .5) == doctest::Approx(.5));
    const auto said = [&](const std::string& text) {
        return std::ranges::any_of(scene.warnings.messages, [&](const std::string& message) {
            return message.find(text) != std::string::npos;
        });
    };
    CHECK(said("material \"m\": baseColorTexture is left out: "));
    CHECK_THROWS_AS(FolderScene(folder, {"gone.gltf"}), InputError);
}

TEST_CASE("maps of normals are left out, which is told once a file") {
    const test::TemporaryFolder folder;
    SmallGltf gltf;
    gltf.image = test::small_png();
    gltf.materials = diffuse("[1,1,1,1]");
    gltf.materials.insert(1, R"("normalTexture":{"index":0},)");
    folder.write("x.glb", gltf.binary());
    folder.write("x.obj",
                 "mtllib x.mtl\nv 2 0 0\nv 3 0 0\nv 3 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n");
    folder.write("x.mtl", "newmtl a\nmap_Bump a.png\nnewmtl b\nnorm b.png\n");
    const FolderScene scene(folder, {"x.glb", "x.obj"});
    const auto count = [&](const char* text) {
        return std::ranges::count_if(scene.warnings.messages, [&](const std::string& message) {
            return message.find(text) != std::string::npos;
        });
    };
    CHECK(count("x.glb: normal textures are left out") == 1);
    CHECK(count("map of heights or normals is left out") == 1);
}

TEST_CASE("an .obj's texture may be a PNG file, and scenes may name one") {
    const test::TemporaryFolder folder;
    folder.write("m/x.obj",
                 "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
                 "vt 0 1\nusemtl a\nf 1/1 2/2 3/3 4/4\n");
    folder.write("m/x.mtl", "newmtl a\nKd 1 .5 1\nillum 1\nmap_Kd s\\t.png\n");
    folder.write("m/s/t.png", test::wide_png());
    folder.write("sky.rad", kWhiteSky);
    folder.write("own.rad",
                 "void colorpict p 7 red green blue m/s/t.png . frac(Px)*2 frac(Pz) 0 0\n"
                 "p plastic a 0 0 5 1 .5 1 0 0\n");
    FolderScene scene(folder, {"m/x.obj", "sky.rad"}, all_around());
    CHECK(red(scene, .3, .6) == doctest::Approx(0.21586).epsilon(1e-4));  // 128 of 255 in sRGB
    FolderScene named(folder, {"own.rad", "m/x.obj", "sky.rad"}, all_around());
    CHECK(red(named, .3, .6) == doctest::Approx(0.21586).epsilon(1e-4));
}

TEST_CASE("a walk watches every file that a scene is read from") {
    const test::TemporaryFolder folder;
    SmallGltf gltf;
    gltf.image = test::small_png();
    folder.write("x.obj",
                 "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    folder.write("x.mtl", "newmtl a\nmap_Kd t.png\n");
    folder.write("t.png", test::wide_png());
    std::string json = gltf.json("my.bin");
    const std::string inside = R"("bufferView":4,"mimeType":"image/png")";
    json.replace(json.find(inside), inside.size(), R"("uri":"u.png")");
    const std::string name = R"({"name":"m"})";
    json.replace(json.find(name), name.size(),
                 R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
    folder.write("x.gltf", json);
    folder.write("my.bin", gltf.buffer());
    folder.write("u.png", gltf.image);
    folder.write("l.ies",
                 "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 .3 .3 0\n1 1 60\n0 90\n0\n10 20\n");
    const std::vector<std::string> names = {"x.obj", "x.gltf", "l.ies"};
    for (const char* file : {"x.obj", "x.mtl", "t.png", "x.gltf", "my.bin", "u.png", "l.ies"}) {
        CAPTURE(file);
        const auto files = std::make_shared<WatchedFiles>();
        const LibraryPath library =
            LibraryPath({LIGHTWALK_SOURCE "/io/library", "."}, files).relative_to(folder.path());
        test::Silence silence;
        FileResources resources(library, false, silence);
        const Scene scene(read_scene(names, {library, false, folder.path(), {}}, silence),
                          modifier_factory, resources, silence);
        CHECK_FALSE(files->have_changed());
        const std::string before = files->read(folder.path(file));
        folder.write(file, before + " ");
        CHECK(files->have_changed());
        folder.write(file, before);
    }
}

}  // namespace lightwalk
