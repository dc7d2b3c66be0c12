// Luminaires' files in scenes: frozen, and on ranks that do not see them.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

void write_lamp(const TemporaryFolder& folder, const std::string& place) {
    folder.write(place + "/lamp.ies",
                 "TILT=INCLUDE\n3\n2\n0 90\n1 .5\n1 1000 2 3 2 1 2 .3 .4 .2\n1 1 60\n0 90 180\n"
                 "0 90\n10 20 30 40 50 60\n");
    folder.write(place + "/other.ies",
                 "TILT=NONE\n1 1000 2 3 1 1 2 -.3 0 .2\n1 1 60\n0 90 180\n0\n10 20 30\n");
    folder.write(place + "/room.rad",
                 "void plastic white 0 0 5 .5 .5 .5 0 0\n"
                 "white polygon floor 0 0 12 -9 -9 -2 9 -9 -2 9 9 -2 -9 9 -2\n"
                 "!ies2rad -s -t default lamp.ies | xform -rx 30 -t 0 0 1\n");
}

const std::vector<std::string> kTrace{"trace", "-h", "-w-", "-ov", "-ds", "0"};
const std::string kRays = "1 1 0 0 0 -1\n0 1 3 0 -1 -2\n0 -.1 -1.9 0 .1 1.9\n1.5 .2 1 -1 -.1 0\n";

ProgramResult trace_in(const std::string& folder, std::vector<std::string> scene,
                       std::vector<std::string> launcher = {}) {
    std::vector<std::string> words = kTrace;
    words.insert(words.end(), scene.begin(), scene.end());
    if (launcher.empty()) launcher = {"env", "--chdir=" + folder};
    return run_program(words, kRays, launcher);
}

}  // namespace

TEST_CASE("luminaires are part of a frozen scene, data and all") {
    const TemporaryFolder folder;
    write_lamp(folder, ".");
    const std::string here = folder.path();
    const ProgramResult expected = trace_in(here, {"room.rad", "other.ies"});
    REQUIRE(expected.status == 0);
    CHECK(expected.out.find("0.000000e+00\t0") == std::string::npos);  // each ray meets light
    const ProgramResult frozen = run_program({"freeze", "room.rad", "other.ies", "-o", "all.lwz"},
                                             "", {"env", "--chdir=" + here});
    CHECK(frozen.status == 0);
    for (const char* name : {"lamp.ies", "other.ies", "room.rad"})
        std::filesystem::remove(folder.path(name));
    const ProgramResult again = trace_in(here, {"--stale", "all.lwz"});
    CHECK(again.status == 0);
    CHECK(again.out == expected.out);
    CHECK(folder.files() == std::vector<std::string>{"all.lwz"});  // nothing else was written
}

TEST_CASE("luminaires reach ranks that see none of the files") {
    if (!mpirun(1)) {
        MESSAGE("skipped: no mpirun here");
        return;
    }
    const TemporaryFolder folder;
    write_lamp(folder, "here");
    folder.write("there/nothing", "");
    const std::string here = folder.path("here");
    const ProgramResult expected = trace_in(here, {"room.rad", "other.ies"});
    REQUIRE(expected.status == 0);
    for (const char* from : {"rank0", "shared"}) {
        std::vector<std::string> words = kTrace;
        for (const char* word :
             {"-n", "1", "--variant", "ranks", "--scene-from", from, "room.rad", "other.ies"})
            words.emplace_back(word);
        std::vector<std::string> line = *mpirun(1, {"--wdir", here});
        line.emplace_back(LIGHTWALK_PROGRAM);
        line.insert(line.end(), words.begin(), words.end());
        for (const std::string& word :
             {std::string(":"), std::string("-n"), std::string("2"), std::string("--wdir"),
              from == std::string("rank0") ? folder.path("there") : here})
            line.push_back(word);
        const ProgramResult ranks = run_program(words, kRays, line);
        CAPTURE(ranks.err);
        CHECK(ranks.status == 0);
        CHECK(ranks.out == expected.out);
    }
}

TEST_CASE("a bad luminaire is refused with its line, and exit status 1") {
    const TemporaryFolder folder;
    folder.write("bad.ies", "TILT=NONE\n1 1 1 2 1 1 7 0 0 0\n");
    const ProgramResult result = trace_in(folder.path(), {"bad.ies"});
    CHECK(result.status == 1);
    CHECK(result.out.empty());
    CHECK(result.err.find("bad.ies:2: bad units") != std::string::npos);
}
