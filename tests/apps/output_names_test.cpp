// The names that pictures may have, and what they then hold.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

const std::string kLitFloor =
    "void plastic white 0 0 5 .5 .5 .5 0 0\nvoid light lamp 0 0 3 9 9 9\n"
    "white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0\nlamp sphere s 0 0 4 0 3 2 .5\n";

struct Renders {
    Renders() : scene(folder.write("room.rad", kLitFloor)) {}
    ProgramResult run(const std::string& command, const std::vector<std::string>& more,
                      const std::string& input = {}) const {
        std::vector<std::string> words{command, "-n",  "1", "-x", "8", "-y",
                                       "8",     "-vp", "0", "0",  "1"};
        words.insert(words.end(), more.begin(), more.end());
        words.push_back(scene);
        return run_program(words, input);
    }
    TemporaryFolder folder;
    std::string scene;
};

bool is_radiance(const std::string& path) {
    return read_whole(path).starts_with("#?RADIANCE\n");
}

}  // namespace

TEST_CASE(
    "render: a name without an ending, with .unf or a number gets what standard output does") {
    const Renders renders;
    for (const std::string name : {"room_a", "room_a.unf", "frame.003"}) {
        const std::string path = renders.folder.path(name);
        CHECK(renders.run("render", {"-o", path}).status == 0);
        CHECK(is_radiance(path));
        CHECK(renders.run("render", {"-pXYZ", "-o", path}).status == 0);
        CHECK(read_whole(path).find("FORMAT=32-bit_rle_xyze") != std::string::npos);
    }
    const std::string views = "VIEW= -vd 0 1 0\nVIEW= -vd 1 0 0\n";
    CHECK(renders.run("render", {"-S", "1", "-o", renders.folder.path("f%03d")}, views).status ==
          0);
    CHECK(is_radiance(renders.folder.path("f001")));
    CHECK(is_radiance(renders.folder.path("f002")));
    const std::string path =
        renders.folder.write("p.vf", "0 VIEW= -vd 0 1 0\n.1 VIEW= -vd 1 1 0\n");
    const ProgramResult walk =
        renders.run("animate", {"--path", path, "--fps", "20", "-o", renders.folder.path("w%d"),
                                "-z", renders.folder.path("z%d")});
    CHECK(walk.err.empty());
    CHECK(is_radiance(renders.folder.path("w1")));
    CHECK(std::filesystem::file_size(renders.folder.path("z1")) % sizeof(float) == 0);
}

TEST_CASE("render: /dev/null takes every output, /dev/stdout is standard output") {
    const Renders renders;
    const std::string null = "/dev/null";
    const ProgramResult none = renders.run("render", {"-o", null, "-z", null, "--stats", null});
    CHECK(none.status == 0);
    CHECK(none.err.empty());
    CHECK(run_program({"freeze", "--quiet", renders.scene, "-o", null}).status == 0);
    CHECK(run_program({"trace", "--stats", null, renders.scene}).status == 0);
    const std::string named = renders.run("render", {"-o", "/dev/stdout"}).out;
    CHECK(named.starts_with("#?RADIANCE\n"));
    const std::string numbered = renders.run("render", {"-o", "/dev/fd/1"}).out;
    CHECK(numbered.substr(numbered.find("\n\n")) == named.substr(named.find("\n\n")));
    CHECK(run_program({"freeze", "--quiet", renders.scene, "-o", "/dev/stdout"}).out.size() > 1000);
    CHECK(std::filesystem::is_character_file(null));
}

TEST_CASE("render: an ending of another format is refused before the scene is read") {
    const Renders renders;
    for (const std::string name : {"a.tif", "a.TIFF", "f%03d.bmp", "a.mp4"}) {
        const ProgramResult result = run_program(
            {"render", "-o", renders.folder.path(name), renders.folder.path("no_such_scene.rad")});
        CHECK(result.status == 1);
        CHECK(result.err.find("unknown kind of picture") != std::string::npos);
    }
    CHECK(renders.folder.files().size() == 1);
}
