// Rad files in place of a scene: what commands make of them, and what command lines say over them.
#include "apps/rad_command.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/material/modifier_factories.h"
#include "tests/apps/program.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void plastic white 0 0 5 .5 .5 .5 0 0
void light lamp 0 0 3 10 10 10
white polygon floor 0 0 12 0 0 0 4 0 0 4 4 0 0 4 0
lamp polygon l 0 0 12 1 1 3 1 3 3 3 3 3 3 1 3
)";

struct RadRoom {
    RadRoom() {
        folder.write("room.rad", kRoom);
        folder.write("v.vf", "rvu -vtv -vp 2 2 1 -vd 0 1 -.5 -vu 0 0 1 -vh 60 -vv 45\n");
        file = folder.write("s.rif", text("ZONE= I 0 4 0 4 0 3\n"));
    }
    [[nodiscard]] std::string text(const std::string& zone) const {
        return "scene= " + folder.path("room.rad") + "\nview= -vf " + folder.path("v.vf") +
               "\nview= side -vp 3.9 2 1 -vd -1 0 0 -va 9\nRESOLUTION= 40 30\nrender= -st .4\n" +
               zone;
    }
    [[nodiscard]] ProgramResult run(const std::vector<std::string>& words,
                                    const std::string& input = "") const {
        return run_program(words, input, {"env", "--chdir=" + folder.path()});
    }
    /// A command line with the rad file behind it, or with the words that stand there.
    template <class Command>
    void take(Command& command, std::vector<std::string> words,
              const std::vector<std::string>& behind = {}) const {
        words.push_back(file);
        words.insert(words.end(), behind.begin(), behind.end());
        (void)take_command_line(command, words, real_files());
    }
    TemporaryFolder folder;
    std::string file;
};

/// What a command's options are once its scene is compiled.
RenderOptions settled(const CommonOptions& common) {
    const TestScene room(kRoom);
    RendererOptions options;
    options.light = common.settings.light;
    common.request.settle(room.scene, options);
    return options.light;
}

std::string pixels_in(const std::string& picture) {
    return picture.substr(std::min(picture.find("\n\n"), picture.size()));
}

}  // namespace

TEST_CASE("a rad file gives its files, its first view, its size and the options of rad") {
    const RadRoom room;
    RenderCommand command("render");
    room.take(command, {});
    CHECK(command.common.scene_files() == std::vector<std::string>{room.folder.path("room.rad")});
    CHECK(command.common.request.history.ends_with(room.file));
    CHECK(command.view.position == Vec3{2, 2, 1});
    CHECK(command.view.horizontal == 60);
    CHECK(command.x == 40);
    CHECK(command.y == 30);
    CHECK(command.common.request.options.pixels.spacing == 8);
    CHECK(command.common.request.options.pixels.samples == 1);
    CHECK(command.output.tone.automatic);
    const RenderOptions light = settled(command.common);
    CHECK(light.ambient_resolution == 17);
    CHECK(light.specular_samples == 0);
    CHECK(light.specular_threshold == .4);  // render= comes after rad's own
    CHECK(light.scatter_step == 0);
    CHECK(light.reflection_limit == 6);
}

TEST_CASE("the command line comes before a rad file, on either side of it") {
    const RadRoom room;
    RenderCommand command("render");
    room.take(command, {"-x", "99", "-v", "side"},
              {"-ar", "5", "-vh", "33", "-ps", "2", "QUALITY=High", "EXPOSURE=-2"});
    CHECK(command.x == 99);
    CHECK(command.y == 30);
    CHECK(command.view.position == Vec3{3.9, 2, 1});
    CHECK(command.view.aft == 9);
    CHECK(command.view.horizontal == 33);
    CHECK(command.common.request.options.pixels.spacing == 2);
    CHECK(command.common.request.options.pixels.samples == 9);
    CHECK_FALSE(command.output.tone.automatic);
    CHECK(command.output.tone.ev == -2);
    const RenderOptions light = settled(command.common);
    CHECK(light.ambient_resolution == 5);
    CHECK(light.scatter_step == .046);
    CHECK(light.ambient_bounces == 1);
    CHECK(light.ambient_value.r == .72F);

    TraceCommand trace;
    room.take(trace, {"-ab", "3"});
    CHECK(settled(trace.common).ambient_bounces == 3);
    CHECK(settled(trace.common).ambient_resolution == 17);
    CHECK(settled(trace.common).reflection_limit == 6);
}

TEST_CASE("a walk lists the views of a rad file: what the command line names comes first") {
    const RadRoom room;
    const auto names = [&](const std::vector<std::string>& words) {
        RenderCommand command("walk");
        room.take(command, words);
        std::string all;
        for (const NamedView& view : command.serve->page.views) all += view.name + ' ';
        return all;
    };
    CHECK(names({}) == "1 side ");
    CHECK(names({"-v", "side"}) == "side 1 ");
    CHECK(names({"-v", "X"}) == "X 1 side ");
    CHECK(names({"-vf", room.folder.path("v.vf")}) == "v 1 side ");
    CHECK(names({"-vp", "1", "1", "1"}) == "start 1 side ");
    RenderCommand command("walk");
    room.take(command, {"-vp", "1", "1", "1"});
    CHECK(command.serve->page.views[0].view.position == Vec3{1, 1, 1});
    CHECK(command.serve->page.views[0].view.horizontal == 60);
    CHECK(command.serve->page.views[2].view.position == Vec3{3.9, 2, 1});
}

TEST_CASE("without a zone it is the scene's cube, seen from outside") {
    const RadRoom room;
    room.folder.write("s.rif", "scene= " + room.folder.path("room.rad") + "\nQUALITY= M\n");
    RenderCommand command("render");
    room.take(command, {});
    const RenderOptions light = settled(command.common);
    CHECK(light.ambient_resolution == 32);
    CHECK(light.scatter_step == .1);
    CHECK(light.ambient_value.r == 10);
    CHECK(command.view.position == Vec3{10, 2, 1.5});
    CHECK(command.view.direction == Vec3{-4, 0, 0});
    RenderCommand other("render");
    room.take(other, {"-vp", "1", "2", "3", "-ms", "7"});
    CHECK(settled(other.common).scatter_step == 7);
    CHECK(other.view.position == Vec3{1, 2, 3});
}

TEST_CASE("every command takes a rad file, and makes of it what its files and options make") {
    const RadRoom room;
    const auto picture = [&](const std::vector<std::string>& words) {
        std::vector<std::string> line{"render", "-o", "p.hdr"};
        line.insert(line.end(), words.begin(), words.end());
        const ProgramResult result = room.run(line);
        CHECK(result.err == "");
        CHECK(result.status == 0);
        return pixels_in(read_whole(room.folder.path("p.hdr")));
    };
    const std::string expected =
        picture({"-vf", "v.vf", "-x",   "40",  "-y",  "30",  "-dp", "128",     "-ar", "17",  "-ds",
                 "0",   "-dt",  ".1",   "-dc", ".5",  "-dr", "0",   "-ss",     "0",   "-st", ".4",
                 "-aa", ".3",   "-ad",  "256", "-as", "0",   "-av", ".01",     ".01", ".01", "-lr",
                 "6",   "-lw",  ".001", "-ps", "8",   "-pt", ".16", "room.rad"});
    REQUIRE(expected.size() > 500);
    CHECK(picture({"s.rif"}) == expected);
    CHECK(picture({"-v", "side", "s.rif"}) != expected);

    const std::string ray = "2 2 1 0 0 -1\n";
    CHECK(room.run({"trace", "-h", "s.rif"}, ray).out ==
          room.run({"trace", "-h", "-ds", "0", "-av", ".01", ".01", ".01", "room.rad"}, ray).out);
    REQUIRE(room.run({"freeze", "s.rif", "-o", "s.lwz"}).status == 0);
    CHECK(room.run({"trace", "-h", "s.lwz"}, ray).out ==
          room.run({"trace", "-h", "room.rad"}, ray).out);
    const ProgramResult info = room.run({"info", "s.rif"});
    CHECK(info.status == 0);
    CHECK(info.out.find("views          1, side\n") != std::string::npos);
    CHECK(info.out.find("-lw .001 -ar 17 -st .4 -ps 8 -pt .16\n") != std::string::npos);
    REQUIRE(
        room.run({"animate", "--rotate", "20", "--frames", "2", "-o", "f%d.hdr", "s.rif"}).status ==
        0);
    CHECK(read_whole(room.folder.path("f1.hdr")).find("-vp 2 2 1 ") != std::string::npos);
}

TEST_CASE("what is wrong with a rad file is told by its line") {
    const RadRoom room;
    const auto refusal = [&](const std::string& text, const std::vector<std::string>& more = {}) {
        room.folder.write("bad.rif", text);
        std::vector<std::string> words{"render", "-o", "p.hdr", "bad.rif"};
        words.insert(words.end(), more.begin(), more.end());
        const ProgramResult result = room.run(words);
        CHECK(result.status != 0);
        return result.err;
    };
    const std::string scene = "scene= room.rad\n";
    CHECK(refusal(scene + "colour= 3\n").starts_with("bad.rif:2: unknown variable \"colour\""));
    CHECK(refusal(scene + "render= -ab x\n") ==
          "bad.rif:2: option -ab: expected an integer, found \"x\"\n");
    CHECK(refusal(scene + "view= a -vp 1 1\n").starts_with("bad.rif:2: option -vp"));
    CHECK(refusal(scene + "view= a room.rad\n").starts_with("bad.rif:2: "));
    CHECK(refusal(scene + "view= a -vf lost.vf\n").starts_with("lost.vf: "));
    CHECK(refusal(scene, {"QUALITY=Q"}) ==
          "QUALITY=Q: expected Low, Medium or High, found \"Q\"\n");
    CHECK(refusal(scene, {"room.rad"}).find("room.rad cannot stand beside it") !=
          std::string::npos);
    CHECK(refusal(scene, {"-v", "lost"}).find("bad.rif: has no view \"lost\"") !=
          std::string::npos);
    CHECK(room.run({"render", "-v", "a", "room.rad", "-o", "p.hdr"}).status == 2);
    CHECK_FALSE(std::filesystem::exists(room.folder.path("p.hdr")));
    const ProgramResult told = room.run({"render", "s.rif", "PICTURE=x", "-o", "p.hdr"});
    CHECK(told.status == 0);
    CHECK(told.err.find("s.rif: PICTURE=: not heeded") != std::string::npos);
}
