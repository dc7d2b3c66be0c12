// lightwalk render --denoise, from outside, with a library that stands for Open Image Denoise.
#include <doctest/doctest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "tests/apps/program.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// A wall that is alike all over, seen by a noisy lobe.
const std::string kWall =
    "void metal rough 0 0 5 .8 .8 .8 .9 .3\n"
    "void glow even 0 0 4 1 1 1 0\neven source sky 0 0 4 0 0 1 90\n"
    "rough polygon wall 0 0 12  -9 9 -9  9 9 -9  9 9 9  -9 9 9\n";

const std::vector<std::string> kWithLibrary{"/usr/bin/env",
                                            "LD_LIBRARY_PATH=" LIGHTWALK_FAKE_DENOISER};

std::vector<std::string> words_for(std::vector<std::string> words, const std::string& scene) {
    words.insert(words.begin(), {"render", "-w-", "-vtl", "-vd", "0", "1", "0", "-vh", "2", "-vv",
                                 "2", "-x", "32", "-y", "32", "-n", "1"});
    words.push_back(scene);
    return words;
}

}  // namespace

TEST_CASE("render: --denoise is for pictures for the screen, with every pixel traced for itself") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("wall.rad", kWall);
    const auto bytes = [&](const std::vector<std::string>& more,
                           const std::vector<std::string>& with) {
        std::vector<std::string> words{"--samples", "4", "-o", folder.path("a.png")};
        words.insert(words.end(), more.begin(), more.end());
        const ProgramResult made = run_program(words_for(words, scene), "", with);
        CHECK(made.status == 0);
        CHECK(made.err.empty());
        return read_whole(folder.path("a.png"));
    };
    const std::string clean = bytes({"--denoise"}, kWithLibrary);
    CHECK(clean.size() < bytes({}, {}).size() / 4);  // of one colour
    for (const std::string name : {"a.hdr", "a.exr", ""}) {
        std::vector<std::string> words{"--denoise"};
        if (!name.empty()) words.insert(words.end(), {"-o", folder.path(name)});
        const ProgramResult refused = run_program(words_for(words, scene), "", kWithLibrary);
        CHECK(refused.status == 2);
        CHECK(refused.err.find("option --denoise: only pictures for the screen") !=
              std::string::npos);
    }
    CHECK(folder.files() == std::vector<std::string>{"a.png", "wall.rad"});
}

TEST_CASE("render: --denoise tells the error before and after it, where half of the rays tell it") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("wall.rad", kWall);
    const ProgramResult made =
        run_program(words_for({"--error", ".4", "--denoise", "-o", folder.path("a.png")}, scene),
                    "", kWithLibrary);
    CHECK(made.status == 0);
    double noisy = 0, clean = 0;
    REQUIRE(std::sscanf(
                made.err.c_str(),
                "lightwalk render: noise of %lf %% of the screen's white, denoised at most %lf %%",
                &noisy, &clean) == 2);
    CHECK(noisy > 1);
    CHECK(noisy < 10);
    CHECK(clean < .7 * noisy);  // the mean of a thousand pixels; of what stays as it is: 1.4
    CHECK(
        run_program(
            words_for({"--error", ".4", "--denoise", "--quiet", "-o", folder.path("a.png")}, scene),
            "", kWithLibrary)
            .err.empty());
}

TEST_CASE(
    "render: --denoise without the library, or where that fails, says so and leaves nothing") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("wall.rad", kWall);
    const std::vector<std::string> words =
        words_for({"--denoise", "-o", folder.path("a.png")}, scene);
    std::vector<std::string> failing = kWithLibrary;
    failing.push_back("FAKE_DENOISER=fail");
    const ProgramResult failed = run_program(words, "", failing);
    CHECK(failed.status == 1);
    CHECK(failed.err.find("Open Image Denoise: no memory") != std::string::npos);
    CHECK(folder.files() == std::vector<std::string>{"wall.rad"});
    const ProgramResult missing = run_program(words, "", {"/usr/bin/env", "-u", "LD_LIBRARY_PATH"});
    if (missing.status == 0) return;  // it is installed here
    CHECK(missing.status == 1);
    CHECK(missing.err.find("option --denoise: Open Image Denoise is not installed: ") !=
          std::string::npos);
    const ProgramResult walk = run_program({"walk", "--denoise", "--port", "0", scene}, "",
                                           {"/usr/bin/env", "-u", "LD_LIBRARY_PATH"});
    CHECK(walk.status == 1);  // before there is a page
    CHECK(walk.out.empty());
    CHECK(walk.err.find("option --denoise: Open Image Denoise is not installed: ") !=
          std::string::npos);
    CHECK(folder.files() == std::vector<std::string>{"wall.rad"});
}
