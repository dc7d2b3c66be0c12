#include "io/scene/frozen_scene.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/material/modifier_factories.h"
#include "io/files/library_path.h"
#include "io/picture/picture.h"
#include "io/scene/file_resources.h"
#include "io/scene/scene_reader.h"
#include "tests/io/scene/binary_writer.h"
#include "tests/temporary_folder.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using test::Silence;
using test::TemporaryFolder;

namespace {

const std::string kRoom = R"rad(
void brightfunc dirt 2 stain dirt.cal 0 0
dirt plastic floor 0 0 5 .5 .4 .3 .1 .1
void brightfunc lost 2 1 lost.cal 0 0
lost plastic unseen 0 0 5 .5 .5 .5 0 0
void brightdata table 5 noneg table.dat . Px Py 0 0
table plastic measured 0 0 5 .5 .5 .5 0 0
void colorpict image 7 noneg noneg noneg image.hdr . frac(Px) frac(Py) 0 0
image plastic painted 0 0 5 .9 .9 .9 0 0
void brighttext sign 2 font.fnt words.txt 0 11 -2 2.99 1 1 0 0 0 0 -1 1 .2
sign plastic lettered 0 0 5 .8 .8 .8 0 0
void plastic one 0 0 5 .8 .1 .1 0 0
void mixfunc both 4 one floor frac(Px) . 0 0
inherit alias other one
void light lamp 0 0 3 20 20 20
void glow sky 0 0 4 1 1 2 0
void mirror silver 1 one 0 3 .9 .9 .9
floor polygon ground 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0
unseen sphere hidden 0 0 4 0 0 -5 1
measured sphere ball 0 0 4 -1 0 1 .5
painted sphere globe 0 0 4 1 0 1 .5
lettered polygon wall 0 0 12 -2 3 0 2 3 0 2 3 2 -2 3 2
both cylinder post 0 0 7 2 1 0 2 1 2 .2
other cup lid 0 0 8 2 1 2 2 1 2.3 .3 .1
other ring plate 0 0 8 -2 1 1 0 -1 1 0 .4
floor ring flat 0 0 8 0 0 0 0 0 1 .2 .2
silver polygon glassy 0 0 12 -3 2 0 -3 1 0 -3 1 2 -3 2 2
lamp polygon panel 0 0 12 -1 -1 5 -1 1 5 1 1 5 1 -1 5
sky source up 0 0 4 0 0 1 180
void instance tree 5 tree.oct -t 0 -1 0 0 0
other instance second 5 tree.oct -t 1 -1 0 0 0
void mesh stone 7 stone.rtm -rx 60 -t 0 -3 1.9 0 0
)rad";

const std::string kFont = "65 4 40 30 200 30 200 220 40 220\n66 3 20 20 240 20 130 240\n";

/// An octree that names its scene file, of an empty tree.
std::string tree_octree() {
    return test::begin_file("Radiance_octree", 287)
        .text("tree.rad")
        .text("")
        .integer(2, 4)
        .integer(0, 1)
        .bytes();
}

/// One triangle of one material.
std::string stone_mesh() {
    test::BinaryWriter file = test::begin_file("Radiance_tmesh", 323);
    file.real(0).real(1).real(0).real(1).integer(0, 1).text("plastic").text("");
    file.integer(0, 1).integer(-1, 4).text("grey").integer(0, 2).integer(5, 2);
    for (const double real : {.5, .5, .5, 0.0, 0.0}) file.real(real);
    file.integer(-1, 1).integer(1, 4).integer(1 | 4, 1).integer(3, 2);
    for (const std::uint32_t code :
         {0x30000000U, 0x60000000U, 0x90000000U, 0x80000000U, 0x70000000U, 0x90000000U, 0x50000000U,
          0xa0000000U, 0xa0000000U})
        file.integer(code, 4);
    for (int i = 0; i < 6; ++i) file.integer(0x40000000, 4);
    file.integer(1, 2).raw(std::string("\0\1\2", 3)).integer(1, 2).integer(0, 2);
    return file.integer(0, 2).integer(0, 2).bytes();
}

void write_room(const TemporaryFolder& folder) {
    folder.write("room.rad", kRoom);
    folder.write("lib/dirt.cal", "stain = .5 + .5*sin(4*Px);\n");
    folder.write("lib/table.dat", "2\n-2 2 3\n0 0 4 -2 0 1 4\n1 2 3 4\n5 6 7 8\n9 10 11 12\n");
    Picture picture{4, 3, {}};
    for (int i = 0; i < 12; ++i) picture.pixels.push_back({.1f * static_cast<float>(i), .5f, .2f});
    folder.write("lib/image.hdr", encode_hdr(picture, {}));
    folder.write("lib/font.fnt", kFont);
    folder.write("lib/words.txt", "AB\nBBA\n");
    folder.write("lib/tree.oct", tree_octree());
    folder.write("tree.rad",
                 "void plastic bark 0 0 5 .3 .2 .1 0 0\nbark sphere crown 0 0 4 0 0 .5 .3\n");
    folder.write("lib/stone.rtm", stone_mesh());
}

/// A scene from files, and the frozen one.
struct Room {
    explicit Room(const TemporaryFolder& folder)
        : library(LibraryPath({"lib"}, manifest).relative_to(folder.path())),
          files(library, false, warnings),
          resources(files),
          scene(read_scene(std::vector<std::string>{folder.path("room.rad")},
                           {library, false, folder.path()}, warnings),
                modifier_factory, resources, warnings) {}
    [[nodiscard]] std::string bytes() const {
        return frozen_scene_bytes(scene, resources, manifest->files());
    }

    Silence warnings;
    std::shared_ptr<ManifestRecorder> manifest = std::make_shared<ManifestRecorder>();
    LibraryPath library;
    FileResources files;
    FreezingResources resources;
    Scene scene;
};

/// Radiance along rays that meet everything in the room, and the names of what they meet.
std::vector<std::string> seen(const Scene& scene) {
    Silence silence;
    const RenderOptions options = test::TestScene::exact();
    const Tracer tracer(scene, options, silence);
    TraceContext context(tracer, silence);
    std::vector<std::string> all;
    for (std::uint32_t i = 0; i < 900; ++i) {
        const Vec3 target{-3.5 + .25 * (i % 30), 2.9, .1 * (i / 30)};
        const Vec3 eye{0, -6, 1.5};
        Ray ray =
            tracer.primary(eye, normalize(target - eye), 0, RandomStream::of_pixel(7, i, 0, 0));
        tracer.trace(ray, context);
        std::string bytes(reinterpret_cast<const char*>(&ray.value), sizeof ray.value);
        if (ray.hit.exists()) bytes += scene.surface(ray.hit.surface).name();
        all.push_back(std::move(bytes));
    }
    return all;
}

std::unique_ptr<FrozenScene> mapped(const std::string& bytes) {
    auto words = std::make_shared<std::vector<std::uint64_t>>(bytes.size() / 8 + 1);
    std::memcpy(words->data(), bytes.data(), bytes.size());
    const auto all = std::as_bytes(std::span(*words)).first(bytes.size());
    return std::make_unique<FrozenScene>(FrozenFile(std::move(words), all, "a.lwz"));
}

}  // namespace

TEST_CASE("rays see the same bytes in a frozen scene, without any of its files") {
    TemporaryFolder folder;
    write_room(folder);
    std::vector<std::string> expected;
    std::vector<std::string> warnings;
    std::string bytes;
    {
        const Room room(folder);
        expected = seen(room.scene);
        warnings = room.warnings.messages;
        bytes = room.bytes();
    }
    std::filesystem::remove_all(folder.path("lib"));
    const auto frozen = mapped(bytes);
    Silence again;
    const Scene scene(frozen->model(), modifier_factory, *frozen, again);
    CHECK(seen(scene) == expected);
    for (const std::string name :
         {"ground", "ball", "globe", "wall", "post", "lid", "crown", "second", "M-Tri"}) {
        CAPTURE(name);
        CHECK(
            std::ranges::any_of(expected, [&](const std::string& s) { return s.ends_with(name); }));
    }
    // The missing file and the degenerate ring are told each time.
    REQUIRE(warnings.size() == 2);
    CHECK(again.messages == warnings);
}

TEST_CASE("a frozen scene that is frozen again has the same bytes") {
    const TemporaryFolder folder;
    write_room(folder);
    const std::string bytes = Room(folder).bytes();
    CHECK(Room(folder).bytes() == bytes);
    const auto frozen = mapped(bytes);
    Silence silence;
    FreezingResources library(*frozen);
    const Scene scene(frozen->model(), modifier_factory, library, silence);
    CHECK(frozen_scene_bytes(scene, library, frozen->manifest()) == bytes);
}

TEST_CASE("columns of a frozen scene are the file's pages") {
    const TemporaryFolder folder;
    write_room(folder);
    const Room room(folder);
    const std::string path = folder.path("room.lwz");
    write_frozen_scene(path, room.scene, room.resources, room.manifest->files());
    CHECK(read_file(path) == room.bytes());
    std::shared_ptr<const Model> model, tree;
    std::shared_ptr<const MeshModel> stone;
    std::shared_ptr<const PictureData> picture;
    {
        const auto frozen = open_frozen_scene(path, false);
        model = frozen->model();
        tree = frozen->octree("tree.oct");
        CHECK(frozen->model() == model);
        CHECK(frozen->octree("tree.oct") == tree);
        stone = frozen->mesh("stone.rtm");
        picture = frozen->picture("image.hdr");
        CHECK(frozen->mesh("stone.rtm") == stone);
        CHECK(frozen->picture("image.hdr") == picture);
    }
    std::filesystem::remove(path);  // models keep the mapping
    for (const auto& one : {model, tree}) {
        CHECK(one->surfaces.columns().records.is_mapped());
        CHECK(one->surfaces.columns().reals.is_mapped());
        REQUIRE(one->shapes);
        CHECK(one->shapes->columns().rows.is_mapped());
        CHECK(one->surfaces.own_bytes() < 1000);
    }
    CHECK(stone->positions.is_mapped());
    CHECK(stone->triangles.is_mapped());
    CHECK(picture->values.is_mapped());
    CHECK(picture->values.size() == 12);
    CHECK(tree->surfaces[0].name == "crown");
    CHECK(model->surfaces[0].where().file.text() == folder.path("room.rad"));
    CHECK(model->surfaces[0].line == room.scene.model().surfaces[0].line);
}

TEST_CASE("what a frozen scene was not asked for when it was frozen is no missing file") {
    const TemporaryFolder folder;
    write_room(folder);
    const auto frozen = mapped(Room(folder).bytes());
    CHECK_THROWS_AS((void)frozen->function_file("lost.cal"), MissingFile);
    CHECK_THROWS_WITH_AS((void)frozen->function_file("new.cal"),
                         "a.lwz: holds no \"new.cal\", which was not needed when it was frozen",
                         InputError);
    CHECK_THROWS_AS((void)frozen->octree("new.oct"), InputError);
}

TEST_CASE("a frozen scene whose files have changed is refused, and they are named") {
    const TemporaryFolder folder;
    write_room(folder);
    const std::string path = folder.path("room.lwz");
    {
        const Room room(folder);
        write_frozen_scene(path, room.scene, room.resources, room.manifest->files());
    }
    const auto refusal = [&] {
        try {
            (void)open_frozen_scene(path, false);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(refusal().empty());
    const std::string end = "; freeze it again, or use --stale";
    folder.write("lib/dirt.cal", "stain = 1;\n");
    CHECK(refusal() == path + ": stale: " + folder.path("lib/dirt.cal") + " has changed" + end);
    folder.write("lib/lost.cal", "one = 1;\n");
    std::filesystem::remove(folder.path("tree.rad"));
    CHECK(refusal() == path + ": stale: " + folder.path("lib/dirt.cal") + " has changed, " +
                           folder.path("lib/lost.cal") + " is new, " + folder.path("tree.rad") +
                           " is missing" + end);
    CHECK(open_frozen_scene(path, true)->model()->surfaces.size() > 10);
    write_room(folder);  // the same bytes, at another time
    std::filesystem::remove(folder.path("lib/lost.cal"));
    CHECK(refusal().empty());
    for (int i = 0; i < 3; ++i) std::filesystem::remove_all(folder.path("lib"));
    CHECK(refusal().find(", and 2 more; freeze it again") != std::string::npos);
}

TEST_CASE("a frozen scene names each of its files once") {
    const TemporaryFolder folder;
    write_room(folder);
    const Room room(folder);
    const auto opens = [&](const std::vector<ManifestFile>& manifest) {
        try {
            return mapped(frozen_scene_bytes(room.scene, room.resources, manifest)) != nullptr;
        } catch (const InputError& error) {
            CHECK(std::string(error.what()) == "a.lwz: damaged: the list of its files");
            return false;
        }
    };
    CHECK(opens({}));
    CHECK(opens({{"/a"}, {"/a/b"}, {"/b"}}));
    CHECK_FALSE(opens({{"/a"}, {"/a"}}));
    CHECK_FALSE(opens({{"/b"}, {"/a"}}));
    CHECK_FALSE(opens({{"/a"}, {"/a/../a"}}));
    CHECK_FALSE(opens({{"a"}}));
}

TEST_CASE("a file is a frozen scene by its first bytes") {
    const TemporaryFolder folder;
    const auto files = real_files();
    CHECK(is_frozen_scene(folder.write("a", "lwfrozen and more"), *files));
    CHECK_FALSE(is_frozen_scene(folder.write("b", "lwfroze"), *files));
    CHECK_FALSE(is_frozen_scene(folder.write("c", ""), *files));
    CHECK_FALSE(is_frozen_scene(folder.path("none"), *files));
    CHECK_FALSE(is_frozen_scene(folder.path(), *files));
    CHECK_FALSE(is_frozen_scene("-", *files));
    CHECK_FALSE(is_frozen_scene("!genbox a b 1 1 1", *files));
}

TEST_CASE("a frozen scene knows which of its parts a generator has written as its sky") {
    const TemporaryFolder folder;
    folder.write("room.rad", R"rad(void plastic grey 0 0 5 .5 .5 .5 0 0
grey sphere ball 0 0 4 0 0 0 1
!gensky 6 21 12 +s
skyfunc glow sky_glow 0 0 4 1 1 1 0
sky_glow source sky 0 0 4 0 0 1 180
)rad");
    const Room room(folder);
    const std::vector<GeneratedPart>& skies = room.scene.model().skies;
    REQUIRE(skies.size() == 1);
    const auto frozen = mapped(room.bytes());
    const std::shared_ptr<const Model> model = frozen->model();
    REQUIRE(model->skies.size() == 1);
    const GeneratedPart &was = skies[0], &is = model->skies[0];
    CHECK(to_prefix(is.where) == to_prefix(was.where));
    CHECK(is.command == was.command);
    CHECK(is.refusal == was.refusal);
    CHECK(is.first_modifier == was.first_modifier);
    CHECK(is.last_modifier == was.last_modifier);
    CHECK(is.last_modifier > is.first_modifier);
    CHECK(is.first_surface == was.first_surface);
    CHECK(is.last_surface == was.last_surface);
    CHECK(is.last_surface > is.first_surface);
}
