// What is found out before a run begins: outputs, processors.
#include <doctest/doctest.h>
#include <sched.h>

#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

std::vector<std::string> line(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "-vp", "0", "-6", "2", "-x", "16", "-y", "12"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace

TEST_CASE("render and freeze: files that cannot be written are told before anything is read") {
    const TemporaryFolder folder;
    const std::string broken = folder.write("broken.rad", "void nonsense");
    const std::string there = folder.path("out.hdr"), nowhere = folder.path("nowhere/file");
    const auto refused = [&](const std::vector<std::string>& words) {
        const ProgramResult result = run_program(words);
        CAPTURE(result.err);
        CHECK(result.status == 1);
        CHECK(result.err.find(nowhere) != std::string::npos);
        CHECK(result.err.find("cannot write") != std::string::npos);
        CHECK(result.err.find("broken.rad") == std::string::npos);
        CHECK(result.out.empty());
    };
    refused(line({"-o", nowhere, broken}));
    refused(line({"-o", there, "-z", nowhere, broken}));
    refused(line({"-o", there, "--stats", nowhere, broken}));
    refused({"freeze", "-o", nowhere, broken});
    CHECK(folder.files() == std::vector<std::string>{"broken.rad"});
}

TEST_CASE("render: as many threads as processors that it may run on") {
    cpu_set_t allowed;
    REQUIRE(sched_getaffinity(0, sizeof allowed, &allowed) == 0);
    int first = 0;
    while (!CPU_ISSET(first, &allowed)) ++first;
    const TemporaryFolder folder;
    const std::string
        scene = folder.write(
            "room.rad", "void plastic floor 0 0 5 .5 .4 .3 0 0\nfloor sphere ball 0 0 4 0 0 1 1\n"),
        stats = folder.path("stats.json");
    const auto threads = [&](const std::vector<std::string>& launcher) {
        const ProgramResult result = run_program(line({"--stats", stats, scene}), "", launcher);
        CAPTURE(result.err);
        REQUIRE(result.status == 0);
        return figure(stats, "/threads");
    };
    CHECK(threads({}) == CPU_COUNT(&allowed));
    CHECK(threads({"taskset", "-c", std::to_string(first)}) == 1);
}
