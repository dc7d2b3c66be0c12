// lightwalk animate, from outside.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "tests/apps/program.h"
#include "tests/apps/walk_words.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 0 0
void plastic satin 0 0 5 .5 .4 .3 .05 .1
void mirror silver 0 0 3 .9 .9 .9
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
satin sphere ball 0 0 4 0 0 1 1
silver polygon glass 0 0 12  2 3 0  5 3 0  5 3 3  2 3 3
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";

double brightness_difference(const Picture& a, const Picture& b) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const float x = brightness(a.pixels[i]), y = brightness(b.pixels[i]);
        off += std::abs(x - y) > 0.1f * y;
    }
    return static_cast<double>(off) / static_cast<double>(a.pixels.size());
}

}  // namespace

TEST_CASE(
    "animate: frames of a turn are those that are traced, and the same for any number of threads") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const auto run = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words{
            "--walk", "turn", "--frames", "6", "-o", folder.path(name + "%02d.hdr"), scene};
        words.insert(words.begin(), more.begin(), more.end());
        const ProgramResult result = run_program(line(words));
        CHECK(result.err.empty());
        CHECK(result.status == 0);
    };
    run("off", {"--reuse", "off", "-ps", "1"});
    // By half a pixel each way: what such a picture is off, a true one may be.
    run("moved", {"--reuse", "off", "-ps", "1", "-vs", ".0078", "-vl", ".0104"});
    run("one", {"-n", "1", "--stats", folder.path("s.json"), "--audit", "10"});
    run("four", {"-n", "4"});
    CHECK(pixels_of(folder.path("off01.hdr")) == pixels_of(folder.path("one01.hdr")));
    run("two", {"-n", "2", "--audit", "10"});
    for (const std::string number : {"01", "02", "03", "04", "05", "06"}) {
        CAPTURE(number);
        CHECK(pixels_of(folder.path("one" + number + ".hdr")) ==
              pixels_of(folder.path("two" + number + ".hdr")));
        const Picture truth = read_hdr(read_whole(folder.path("off" + number + ".hdr")), "off");
        const Picture reused = read_hdr(read_whole(folder.path("four" + number + ".hdr")), "four");
        const Picture moved = read_hdr(read_whole(folder.path("moved" + number + ".hdr")), "moved");
        CHECK(brightness_difference(reused, truth) < brightness_difference(moved, truth) + 0.01);
    }
    const auto stats = nlohmann::json::parse(read_whole(folder.path("s.json")));
    CHECK(stats["command"] == "animate");
    CHECK(stats["picture"]["frames"] == 6);
    CHECK(stats["reuse"]["frames"].size() == 6);
    CHECK(stats["reuse"]["frames"][0]["reused"] == 0);
    CHECK(stats["reuse"]["reused"] > 0.5);
    CHECK(stats["reuse"]["audit"]["pixels"] > 100);
}

TEST_CASE("animate: a path's views are frames, or keys between which frames lie") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string path = folder.write("walk.vf",
                                          "VIEW= -vp 0 -6 2 -vd 0 1 -.2\n"
                                          "3 VIEW= -vp 1 -6 2\n");
    CHECK(run_program(line({"--path", path, "-o", folder.path("a%d.png"), scene})).status == 0);
    CHECK(std::filesystem::exists(folder.path("a2.png")));
    CHECK(!std::filesystem::exists(folder.path("a3.png")));
    CHECK(run_program(line({"--path", path, "--frames", "5", "-o", folder.path("b%d.hdr"), scene}))
              .status == 0);
    PictureHeader header;
    (void)read_hdr(read_whole(folder.path("b3.hdr")), "b3", &header);
    CHECK(std::any_of(header.lines.begin(), header.lines.end(), [](const std::string& text) {
        return text.find("-vp 0.5 -6 2") != std::string::npos;
    }));
}

TEST_CASE("animate: what it cannot do it says, and writes nothing") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string out = folder.path("f%d.hdr");
    const auto refused = [&](std::vector<std::string> words, const std::string& text) {
        words.push_back(scene);
        const ProgramResult result = run_program(line(words));
        CAPTURE(result.err);
        CHECK(result.err.find(text) != std::string::npos);
        CHECK(!std::filesystem::exists(folder.path("f1.hdr")));
        return result.status;
    };
    CHECK(refused({"-o", out}, "no walk: say --path") == 2);
    CHECK(refused({"--walk", "turn", "-o", out}, "need --frames") == 2);
    CHECK(refused({"--walk", "up", "--frames", "2", "-o", out}, "expected one of turn, forward") ==
          2);
    CHECK(refused({"--walk", "turn", "--rotate", "3", "--frames", "2", "-o", out},
                  "only one of them") == 2);
    CHECK(refused({"--walk", "turn", "--frames", "2", "-o", folder.path("f1.hdr")},
                  "with %d for their numbers") == 2);
    CHECK(refused({"--walk", "turn", "--frames", "2", "-pd", "1", "-o", out}, "--reuse off") == 2);
    CHECK(refused({"--walk", "turn", "--frame", "2", "-o", out}, "did you mean --frames?") == 2);
    CHECK(refused({"--drop", "all", "-o", out}, "expected one of both, hidden") == 2);
    CHECK(refused({"--budget", "-1", "-o", out}, "option --budget: expected a number from 0") == 2);
    CHECK(refused({"--reach", "2", "-o", out}, "option --reach: expected a number from 0 to 1.5") ==
          2);
    const std::string path = folder.write("bad.vf", "VIEW= -vp 0 0 1\nnonsense\n");
    CHECK(refused({"--path", path, "-o", out}, "bad.vf:2: expected a view") == 1);
}

namespace {

/// Another search path for programs, while it lives.
class SearchPath {
  public:
    explicit SearchPath(const std::string& folders) : before_(std::getenv("PATH")) {
        ::setenv("PATH", folders.c_str(), 1);
    }
    ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }
    SearchPath(const SearchPath&) = delete;
    SearchPath& operator=(const SearchPath&) = delete;

  private:
    std::string before_;
};

/// Something that looks like ffmpeg: it writes its last word's file.
void write_encoder(const TemporaryFolder& folder, const std::string& script) {
    const std::string path = folder.write("ffmpeg", "#!/bin/sh\n" + script);
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

}  // namespace

TEST_CASE("animate: a film is encoded by ffmpeg, and appears whole or not at all") {
    const TemporaryFolder folder, tools;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string film = folder.path("walk.mp4");
    const auto run = [&] {
        return run_program(line({"--walk", "turn", "--frames", "3", "-o", film, scene}));
    };
    const std::string usual = std::getenv("PATH");
    {
        const SearchPath nothing(tools.path(""));
        const ProgramResult result = run();
        CHECK(result.status == 1);
        CHECK(result.err.find("ffmpeg, which is not installed") != std::string::npos);
    }
    const SearchPath path(tools.path("") + ":" + usual);
    write_encoder(tools, "echo \"$@\" >" + tools.path("words") +
                             "\nfor last; do :; done\ncat >\"${last#file:}\"\n");
    const ProgramResult result = run();
    CAPTURE(result.err);
    CHECK(result.status == 0);
    CHECK(read_whole(film).size() == 3 * 3 * 63 * 48);
    CHECK(read_whole(tools.path("words")).find("-s 63x48 -framerate 25 ") != std::string::npos);
    CHECK(folder.files().size() == 2);
    write_encoder(tools, "for last; do :; done\ncat >\"${last#file:}\"\nexit 1\n");
    const std::string before = read_whole(film);
    const ProgramResult failed = run();
    CHECK(failed.status == 1);
    CHECK(failed.err.find("walk.mp4: ffmpeg has failed") != std::string::npos);
    CHECK(read_whole(film) == before);
    CHECK(folder.files().size() == 2);
}

TEST_CASE("animate: a path that stands still is refined, a budget is no error") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string path = folder.write("still.vf",
                                          "VIEW= -vp 0 -6 2\n"
                                          "VIEW= -vp 0 -5.9 2\n"
                                          "VIEW= -vp 0 -5.9 2\n"
                                          "VIEW= -vp 0 -5.9 2\n");
    const std::string stats = folder.path("s.json");
    CHECK(run_program(line({"--path", path, "--refine", "100", "--budget", "1000", "--stats", stats,
                            "-o", folder.path("f%d.hdr"), scene}))
              .status == 0);
    CHECK(run_program(line({"--path", path, "--reuse", "off", "-ps", "1", "-o",
                            folder.path("g%d.hdr"), scene}))
              .status == 0);
    CHECK(pixels_of(folder.path("f3.hdr")) == pixels_of(folder.path("g3.hdr")));
    CHECK(pixels_of(folder.path("f4.hdr")) != pixels_of(folder.path("g4.hdr")));  // smoother
    const auto frames = nlohmann::json::parse(read_whole(stats))["reuse"]["frames"];
    CHECK(frames[2]["traced"]["refined"] > 0);
    CHECK(frames[1]["filled"] == 0);
}

TEST_CASE("animate --resume: frames that are there stay, the others are those of the whole walk") {
    const TemporaryFolder folder;
    (void)folder.write("room.rad", kRoom);
    const auto walk = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words{"--walk", "forward", "--frames", "4", "-w-"};
        words.insert(words.end(), more.begin(), more.end());
        words.insert(words.end(), {"-o", folder.path(name), folder.path("room.rad")});
        return run_program(line(words));
    };
    const auto frame = [&](int number) {
        return folder.path("f" + std::to_string(number) + ".hdr");
    };
    REQUIRE(walk("f%d.hdr", {"--reuse", "off"}).status == 0);
    const std::string third = pixels_of(frame(3));
    (void)folder.write("f2.hdr", "stays");
    std::filesystem::remove(frame(3));
    CHECK(walk("f%d.hdr", {"--reuse", "off", "--resume"}).status == 0);
    CHECK(read_whole(frame(2)) == "stays");
    CHECK(pixels_of(frame(3)) == third);
    // Frames that reuse points begin anew where some were left out.
    std::filesystem::remove(frame(3));
    CHECK(walk("f%d.hdr", {"--resume"}).status == 0);
    CHECK(read_whole(frame(2)) == "stays");
    CHECK(std::filesystem::exists(frame(3)));
    // What all frames have in common must not depend on those that are not drawn.
    CHECK(walk("f%d.png", {"--resume"}).status == 2);
    CHECK(walk("f%d.png", {"--resume", "--exposure", "0"}).status == 0);
    CHECK(walk("f.mp4", {"--resume"}).status == 2);
    CHECK(walk("f%d.hdr", {"--checkpoint", folder.path("c")}).err.find("--resume") !=
          std::string::npos);
}
