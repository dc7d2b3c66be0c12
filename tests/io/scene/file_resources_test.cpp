#include "io/scene/file_resources.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "tests/backward_task_runner.h"
#include "tests/io/scene/binary_writer.h"
#include "tests/temporary_folder.h"
#include "tests/test_scene.h"

namespace lightwalk {
namespace {

/// A ball, and the tree that holds it.
std::string frozen_ball() {
    test::BinaryWriter file = test::begin_file("Radiance_octree", 287);
    file.text("").integer(1, 4);
    file.integer(1, 1).integer(1, 4).integer(0, 4);
    file.text("sphere").text("");
    file.integer(0, 1).integer(-1, 4).text("frozen ball").integer(0, 2).integer(4, 2);
    for (const double real : {0.0, 0.0, 0.0, 1.0}) file.real(real);
    return file.integer(-1, 1).bytes();
}

TEST_CASE("files are found along the path, decoded once, and shared") {
    const test::TemporaryFolder folder;
    folder.write("lib/f.cal", "x=1;");
    folder.write("lib/ramp.dat", "1\n0 1 2\n3 5\n");
    test::Silence silence;
    FileResources resources(LibraryPath({"lib"}).relative_to(folder.path()), false, silence);
    CHECK(resources.function_file("f.cal") == "x=1;");
    const auto table = resources.data("ramp.dat");
    CHECK(table->values == std::vector<float>{3, 5});
    CHECK(resources.data("ramp.dat") == table);
}

TEST_CASE("a picture that is not there may have the other ending, .pic for .hdr and back") {
    const test::TemporaryFolder folder;
    const auto grey = [](float value) { return encode_hdr({1, 1, {Rgb::grey(value)}}, {}); };
    folder.write("a/new.hdr", grey(1));
    folder.write("a/old.pic", grey(2));
    folder.write("a/both.hdr", grey(4));
    folder.write("b/both.pic", grey(8));
    test::Silence silence;
    FileResources resources(LibraryPath({"a", "b"}).relative_to(folder.path()), false, silence);
    const auto value = [&](const std::string& name) {
        return static_cast<double>(resources.picture(name)->values[0].r);
    };
    const auto about = [](double x) { return doctest::Approx(x).epsilon(1.0 / 256); };  // RGBE
    CHECK(value("new.pic") == about(1));
    CHECK(value("new.hdr") == about(1));
    CHECK(value("old.hdr") == about(2));
    CHECK(value("both.hdr") == about(4));
    CHECK(value("both.pic") == about(8));  // the name as it stands comes first, in every folder
    for (const std::string name : {"none.pic", "none.hdr", "new.exr", "new", ".pic"}) {
        CHECK_THROWS_WITH_AS((void)resources.picture(name),
                             doctest::Contains(("cannot find picture file \"" + name).c_str()),
                             InputError);
    }
}

TEST_CASE("an octree that is not frozen reads its scene files from the base directory") {
    const test::TemporaryFolder folder;
    folder.write("ball.rad", "void sphere s 0 0 4 0 0 0 1");
    test::BinaryWriter file = test::begin_file("Radiance_octree", 287);
    folder.write("lib/ball.oct",
                 file.text("ball.rad").text("").integer(1, 4).integer(0, 1).bytes());
    test::Silence silence;
    FileResources resources(LibraryPath({"lib"}).relative_to(folder.path()), false, silence);
    const auto model = resources.octree("ball.oct");
    CHECK(model->surfaces[0].name == "s");
    CHECK(resources.octree("ball.oct") == model);
}

TEST_CASE("files that were prepared are there, what is wrong with others is told when asked for") {
    const test::TemporaryFolder folder;
    const auto grey = [](float value) { return encode_hdr({1, 1, {Rgb::grey(value)}}, {}); };
    folder.write("lib/one.hdr", grey(1));
    folder.write("lib/two.pic", grey(2));
    folder.write("lib/damaged.hdr", grey(3).substr(0, 20));
    folder.write("ball.rad", "void sphere s 0 0 4 0 0 0 1");
    folder.write("lib/ball.oct", test::begin_file("Radiance_octree", 287)
                                     .text("ball.rad")
                                     .text("")
                                     .integer(1, 4)
                                     .integer(0, 1)
                                     .bytes());
    folder.write("lib/frozen.oct", frozen_ball());
    test::Silence silence;
    FileResources resources(LibraryPath({"lib"}).relative_to(folder.path()), false, silence);
    using Kind = NamedFile::Kind;
    const std::vector<NamedFile> files{{Kind::picture, "one.hdr"},     {Kind::picture, "two.hdr"},
                                       {Kind::picture, "damaged.hdr"}, {Kind::picture, "no.hdr"},
                                       {Kind::octree, "ball.oct"},     {Kind::octree, "frozen.oct"},
                                       {Kind::octree, "no.oct"},       {Kind::mesh, "no.rtm"}};
    resources.prepare(files, test::BackwardTaskRunner());
    for (const char* name : {"lib/one.hdr", "lib/two.pic", "lib/frozen.oct"})
        std::filesystem::remove(folder.path(name));
    CHECK(static_cast<double>(resources.picture("one.hdr")->values[0].r) ==
          doctest::Approx(1).epsilon(1.0 / 256));
    CHECK(static_cast<double>(resources.picture("two.hdr")->values[0].r) ==
          doctest::Approx(2).epsilon(1.0 / 256));
    CHECK(resources.octree("frozen.oct")->surfaces[0].name == "frozen ball");
    CHECK(resources.octree("ball.oct")->surfaces[0].name == "s");
    CHECK_THROWS_WITH_AS((void)resources.picture("damaged.hdr"), doctest::Contains("damaged.hdr: "),
                         InputError);
    CHECK_THROWS_AS((void)resources.picture("no.hdr"), MissingFile);
    CHECK_THROWS_AS((void)resources.octree("no.oct"), MissingFile);
    CHECK_THROWS_AS((void)resources.mesh("no.rtm"), MissingFile);
}

TEST_CASE("a missing file names its kind and where it was looked for") {
    test::Silence silence;
    FileResources resources(LibraryPath({"/no", "/where"}), false, silence);
    const auto message_of = [](const auto& action) -> std::string {
        try {
            static_cast<void>(action());
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    CHECK(message_of([&] { return resources.function_file("f"); }) ==
          "cannot find function file \"f\" in /no:/where");
    CHECK(message_of([&] { return resources.data("f"); }) ==
          "cannot find data file \"f\" in /no:/where");
    CHECK(message_of([&] { return resources.picture("f"); }) ==
          "cannot find picture file \"f\" in /no:/where");
    CHECK(message_of([&] { return resources.font("f"); }) ==
          "cannot find font file \"f\" in /no:/where");
    CHECK(message_of([&] { return resources.text_lines("f"); }) ==
          "cannot find text file \"f\" in /no:/where");
    CHECK(message_of([&] { return resources.octree("f"); }) ==
          "cannot find octree file \"f\" in /no:/where");
    CHECK(message_of([&] { return resources.mesh("f"); }) ==
          "cannot find mesh file \"f\" in /no:/where");
}

TEST_CASE("lines of a text file: the last end is optional, long ones break after 511 bytes") {
    const test::TemporaryFolder folder;
    folder.write("t", "one\n\n" + std::string(512, 'x') + "\n" + std::string(511, 'y') + "\nend");
    test::Silence silence;
    FileResources resources(LibraryPath({folder.path()}), false, silence);
    using Lines = std::vector<std::string>;
    CHECK(resources.text_lines("t") ==
          Lines{"one", "", std::string(511, 'x'), "x", std::string(511, 'y'), "end"});
    folder.write("t", "one\n");
    CHECK(resources.text_lines("t") == Lines{"one"});
}

}  // namespace
}  // namespace lightwalk
