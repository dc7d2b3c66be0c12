#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "io/scene/binary_models.h"
#include "io/scene/scene_reader.h"
#include "tests/all_primitives.h"
#include "tests/io/scene/binary_writer.h"
#include "tests/temporary_folder.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::BinaryWriter;
using test::within;

BinaryWriter octree() {
    return test::begin_file("Radiance_octree", 287);
}

/// One object of type number `type` (B = 4).
void add_object(BinaryWriter& file, int type, int modifier, const std::string& name,
                const std::vector<std::string>& strings, const std::vector<double>& reals) {
    file.integer(type, 1).integer(modifier, 4).text(name);
    file.integer(static_cast<std::int64_t>(strings.size()), 2);
    for (const std::string& string : strings) file.text(string);
    file.integer(static_cast<std::int64_t>(reals.size()), 2);
    for (const double real : reals) file.real(real);
}

/// Types 0 plastic, 1 sphere, 2 alias, 3 one that nobody knows; objects red, ball; alias blue, its
/// user; alias with another modifier, its user; antimatter is not there.
std::string frozen_octree(int objects = 7) {
    BinaryWriter file = octree();
    file.text("").integer(objects, 4);
    file.integer(2, 1);  // the tree: eight leaves, one of them full
    for (int i = 0; i < 7; ++i) file.integer(0, 1);
    file.integer(1, 1).integer(2, 4).integer(1, 4).integer(3, 4);
    file.text("plastic").text("sphere").text("alias").text("warpfield").text("brightfunc").text("");
    add_object(file, 4, -1, "dirt", {"dirt", "dirt.cal"}, {0.5});
    add_object(file, 0, 0, "red", {}, {0.7, 0.1, 0.1, 0, 0});
    add_object(file, 1, 1, "ball", {}, {0, 0, 0, 1});
    add_object(file, 2, 1, "blue", {}, {});
    add_object(file, 1, 3, "blue ball", {}, {3, 0, 0, 1});
    add_object(file, 2, -1, "plain", {"red"}, {});
    add_object(file, 1, 5, "plain ball", {}, {6, 0, 0, 1});
    return file.integer(-1, 1).bytes();
}

std::string octree_message(const std::string& bytes) {
    try {
        static_cast<void>(decode_octree(bytes, "x.oct"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST_CASE("an octree is told from scene text by its header") {
    CHECK(is_octree(octree().bytes()));
    CHECK(is_octree("#?RADIANCE\r\nFORMAT= Radiance_octree \r\n\r\n"));
    CHECK_FALSE(is_octree("#?RADIANCE\n\tFORMAT=Radiance_octree\n\n"));
    CHECK_FALSE(is_octree("#?RADIANCE\nFORMAT=Radiance_tmesh\n\n"));
    CHECK_FALSE(is_octree("void plastic m 0 0 5 1 1 1 0 0\n\nFORMAT=Radiance_octree\n\n"));
    CHECK_FALSE(is_octree("FORMAT=Radiance_octree"));
    CHECK_FALSE(is_octree(""));
}

TEST_CASE("a frozen octree holds its objects, types go by name, aliases rename or replace") {
    const OctreeContents contents = decode_octree(frozen_octree(), "x.oct");
    REQUIRE(contents.model);
    const std::vector<Primitive>& modifiers = contents.model->modifiers;
    const std::vector<Primitive> surfaces = test::surfaces_of(*contents.model);
    REQUIRE(modifiers.size() == 4);
    REQUIRE(surfaces.size() == 3);
    CHECK(modifiers[1].type == PrimitiveType::plastic);
    CHECK(modifiers[1].modifier == 0);
    CHECK(modifiers[1].reals[0] == within(0x1p-31, 0.7) /* a unit of the mantissa */);
    CHECK(surfaces[0].name == "ball");
    CHECK(surfaces[0].reals[3] == 1);
    CHECK(modifiers[2].type == PrimitiveType::alias);  // "blue" renames "red", its pattern included
    CHECK(modifiers[2].modifier == 0);
    CHECK(modifiers[2].references == std::vector<std::int32_t>{1});
    CHECK(surfaces[1].modifier == 2);
    CHECK(modifiers[3].type == PrimitiveType::alias);  // "plain" is "red" without it
    CHECK(modifiers[3].modifier == kVoidIndex);
    CHECK(modifiers[3].references == std::vector<std::int32_t>{1});
    CHECK(surfaces[2].modifier == 3);
    CHECK(modifiers[3].where.file == "x.oct");
    CHECK(contents.objects == 7);
    CHECK(contents.model->header == std::vector<std::string>{"#?RADIANCE", "oconv -f x.rad"});
    REQUIRE(contents.model->cube);
    CHECK(contents.model->cube->z == -3);
    CHECK(contents.model->cube->size == 4.5);
}

TEST_CASE("a surface that is the modifier of another object is refused") {
    BinaryWriter file = octree();
    file.text("").integer(2, 4).integer(0, 1).text("sphere").text("metal").text("");
    add_object(file, 0, -1, "ball", {}, {0, 0, 0, 1});
    add_object(file, 1, 0, "m", {}, {});
    const std::string bytes = file.integer(-1, 1).bytes();
    CHECK_THROWS_WITH_AS(static_cast<void>(decode_octree(bytes, "x.oct")),
                         doctest::Contains("a surface cannot be a modifier: sphere \"ball\""),
                         InputError);
}

TEST_CASE("counts of strings and numbers are unsigned") {
    BinaryWriter file = octree();
    file.text("").integer(1, 4).integer(0, 1).text("polygon").text("");
    add_object(file, 0, -1, "big", {}, std::vector<double>(39999, 1));
    const OctreeContents contents = decode_octree(file.integer(-1, 1).bytes(), "x.oct");
    CHECK(contents.model->surfaces[0].reals.size() == 39999);
}

TEST_CASE("object numbers may take 1 to 8 bytes") {
    BinaryWriter file = test::begin_file("Radiance_octree", 283 + 8);
    file.text("").integer(1, 8).integer(1, 1).integer(1, 8).integer(0, 8).text("sphere").text("");
    file.integer(0, 1).integer(-1, 8).text("s").integer(0, 2).integer(1, 2).real(2).integer(-1, 1);
    CHECK(decode_octree(file.bytes(), "x.oct").model->size() == 1);
}

TEST_CASE("bad octrees are refused with a reason") {
    const std::string head = octree().bytes();
    const auto tree = [&](const BinaryWriter& bytes) {
        return octree_message(octree().text("").integer(0, 4).raw(bytes.bytes()).bytes());
    };
    CHECK(octree_message("#?RADIANCE\nFORMAT=ascii\n\n") ==
          "x.oct: not an octree: FORMAT=ascii, expected Radiance_octree");
    CHECK(octree_message(test::begin_file("Radiance_octree", 283).bytes()) ==
          "x.oct: incompatible octree format");
    CHECK(octree_message(test::begin_file("Radiance_octree", 292).bytes()) ==
          "x.oct: incompatible octree format");
    CHECK(octree_message(head) == "x.oct: truncated octree");
    CHECK(tree(BinaryWriter().integer(3, 1)) == "x.oct: damaged tree: unknown node tag");
    CHECK(tree(BinaryWriter().integer(1, 1).integer(512, 4)) ==
          "x.oct: damaged tree: a leaf of 512 objects");
    CHECK(tree(BinaryWriter().integer(1, 1).integer(0, 4)) ==
          "x.oct: damaged tree: a leaf of 0 objects");
    CHECK(tree(BinaryWriter().raw(std::string(100000, '\2'))) == "x.oct: truncated octree");
    CHECK(octree_message(frozen_octree(8)) == "x.oct: holds 7 objects, expected 8");

    const auto object = [&](int type, int modifier, const std::string& name) {
        BinaryWriter file = octree();
        file.text("").integer(2, 4).integer(0, 1).text("sphere").text("plastic").text("warp").text(
            "");
        add_object(file, 0, -1, "s", {}, {});
        add_object(file, type, modifier, name, {}, {});
        return octree_message(file.integer(-1, 1).bytes());
    };
    CHECK(object(1, -1, "m") == "no error");
    CHECK(object(1, 0, "m") == "x.oct: a surface cannot be a modifier: sphere \"s\"");
    CHECK(object(1, 1, "m") ==
          "x.oct: object 1 has modifier number 1, expected that of an earlier object");
    CHECK(object(1, -2, "m") ==
          "x.oct: object 1 has modifier number -2, expected that of an earlier object");
    CHECK(object(2, -1, "m") == "x.oct: reference to unknown type \"warp\"");
    CHECK(object(9, -1, "m") == "x.oct: reference to unknown type number 9");
    CHECK(object(-5, -1, "m") == "x.oct: reference to unknown type number -5");
    CHECK(object(1, -1, "void") == "x.oct: illegal modifier name \"void\"");
}

TEST_CASE("every truncation of an octree is an error") {
    const std::string whole = frozen_octree();
    CHECK(octree_message(whole) == "no error");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        CAPTURE(size);
        CHECK(octree_message(whole.substr(0, size)).starts_with("x.oct: "));
    }
}

TEST_CASE("an octree that refers to scene files reads them, and tells when it is stale") {
    const test::TemporaryFolder folder;
    folder.write("mat.rad", "void plastic red 0 0 5 1 1 1 0 0 inherit alias blue red");
    folder.write("geo.rad", "blue sphere s 0 0 4 0 0 0 1");
    const auto referring = [](int objects) {
        BinaryWriter file = octree();
        return file.text("mat.rad")
            .text("geo.rad")
            .text("!cat geo.rad")
            .text("")
            .integer(objects, 4)
            .integer(0, 1)
            .bytes();
    };
    folder.write("good.oct", referring(4));
    const std::string stale = folder.write("stale.oct", referring(5));
    test::Silence silence;
    const SceneReadOptions options{LibraryPath({"."}), false, folder.path()};
    const auto read = [&](const std::vector<std::string>& files) {
        return read_scene(files, options, silence);
    };
    const auto model = read({"good.oct"});
    CHECK(model->size() == 4);
    CHECK(model->header.size() == 2);
    CHECK(model->cube->size == 4.5);
    CHECK_THROWS_WITH_AS(
        read({"stale.oct"}),
        (stale + ": bad object count; octree stale? Its scene files hold 4 primitives, expected 5")
            .c_str(),
        InputError);
    CHECK_THROWS_WITH_AS(read({"mat.rad", "good.oct"}),
                         (folder.path() + "/good.oct: " + kOneBase).c_str(), InputError);
}

}  // namespace
}  // namespace lightwalk
