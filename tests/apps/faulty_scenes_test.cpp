// Scenes of which a part is missing are refused by every command, also where warnings are off.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

const std::string kRoom =
    "void plastic white 0 0 5 .5 .5 .5 0 0\n"
    "white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0\n";

/// All commands that read a scene end with exit status 1 and a message, and write nothing.
void check_refused(const std::string& scene, const std::string& message,
                   const std::string& input = {}) {
    const TemporaryFolder folder;
    const std::string picture = folder.path("x.hdr"), frozen = folder.path("x.lwz");
    std::vector<std::vector<std::string>> lines{
        {"render", "-w", "-n", "1", "-x", "8", "-y", "8", "-o", picture, scene},
        {"info", "-w", scene},
        {"freeze", "--quiet", scene, "-o", frozen}};
    if (scene != "-") lines.push_back({"trace", "-w", "-h", "-n", "1", scene});
    for (const std::vector<std::string>& line : lines) {
        CAPTURE(scene);
        CAPTURE(line.front());
        const ProgramResult result = run_program(line, scene == "-" ? input : "0 0 1 0 0 -1\n");
        CHECK(result.status == 1);
        CHECK(result.err.find(message) != std::string::npos);
        if (line.front() == "trace") CHECK(result.out.empty());
    }
    CHECK(folder.files().empty());
}

}  // namespace

TEST_CASE("an octree, frozen scene or mesh that is empty or cut off is no scene of nothing") {
    const TemporaryFolder folder;
    const std::string room = folder.write("room.rad", kRoom), whole = folder.path("whole.lwz");
    REQUIRE(run_program({"freeze", "--quiet", room, "-o", whole}).status == 0);
    const std::string frozen = read_whole(whole);
    check_refused(folder.write("empty.oct", ""), "not an octree: the file is empty");
    check_refused(folder.write("cut.oct", "#?RADIANCE\n"), "not an octree");
    check_refused(folder.write("header.oct", "#?RADIANCE\nFORMAT=Radiance_octree\n\n"), "octree");
    check_refused(folder.write("empty.lwz", ""), "not a frozen scene: the file is empty");
    for (const std::size_t bytes :
         {std::size_t{1}, std::size_t{4}, std::size_t{20}, frozen.size() / 2, frozen.size() - 1})
        check_refused(folder.write("cut.lwz", frozen.substr(0, bytes)), "cut.lwz: ");
    check_refused("-", "standard input: empty");
    for (const std::string cut : {"#?", "#?RAD", "#?RADIANCE\n"})
        check_refused("-", "standard input: ", cut);
    for (const std::string name : {"in.oct", "in.rtm"}) {
        const std::string file = folder.write(name, "");
        const std::string type = name == "in.oct" ? "instance" : "mesh";
        check_refused(folder.write("outer.rad", "void " + type + " i 1 " + file + " 0 0\n"), file);
    }
}

TEST_CASE("a command of a scene that fails, or whose file is missing, is an error with its line") {
    const TemporaryFolder folder;
    const std::string lamps =
        folder.write("lamps.rad", "void light lamp 0 0 3 1 1 1\nlamp shpere s 0 0 4 0 0 1 .1\n");
    const std::string nested =
        folder.write("nested.rad", "!xform -t 0 0 1 " + folder.path("none.rad") + "\n");
    const auto with = [&](const std::string& line) {
        return folder.write("room.rad", kRoom + line + "\n");
    };
    const std::string line = "room.rad:3: bad status from \"!";
    check_refused(with("!xform -t 1 0 0 " + lamps), "unknown type \"shpere\"");
    check_refused(with("!xform -t 1 0 0 " + lamps), line);
    check_refused(with("!xform -t 1 0 0 none.rad"), line);
    check_refused(with("!xform " + nested), line);
    check_refused(with("!cat none.rad"), line);
    check_refused(with("!cat " + lamps + " none.rad"), line);
    check_refused(with("!genbox white box 1 2"), line);
    check_refused(with("!cat " + lamps + " | xform -t 1 0"), line);
    check_refused(with("!xform -t 1 0 0 " + lamps + "\n!nothing"), "command \"nothing\"");
    check_refused(with("void instance i 1 none.oct 0 0"), "none.oct");
    check_refused(with("void mesh m 1 none.rtm 0 0"), "none.rtm");
    check_refused("!xform " + lamps, "unknown type \"shpere\"");
    // An empty scene file is allowed, and so is what a command makes of it.
    const std::string nothing = folder.write("nothing.rad", "");
    const ProgramResult empty = run_program({"info", with("!xform " + nothing)});
    CHECK(empty.status == 0);
    CHECK(empty.err.find("empty file") != std::string::npos);
}

TEST_CASE("info: a pattern or material whose file is missing cannot be rendered") {
    const TemporaryFolder folder;
    const std::string scene = folder.write(
        "room.rad",
        "void brightdata p 4 noop none.dat . Px 0 0\np plastic white 0 0 5 1 1 1 0 0\n" +
            kRoom.substr(kRoom.find('\n') + 1));
    const ProgramResult result = run_program({"info", "-w", scene});
    CHECK(result.status == 1);
    CHECK(result.err.find("room.rad:1: brightdata \"p\": cannot find data file") !=
          std::string::npos);
    CHECK(result.out.find("primitives") != std::string::npos);
}
