// What runs on ranks say and write, beside pictures.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/rank_runs.h"

using namespace lightwalk::test;
using namespace lightwalk::test::rank_runs;

TEST_CASE("render on ranks: what is wrong is the only thing that is said") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string bad = folder.write("bad.rad", "void plastic p 0 0 5 1 1 one 0 0\n");
    for (const char* variant : {"ranks", "hybrid"}) {
        const ProgramResult wrong = run_program(
            line({"--variant", variant, "-o", folder.path("none.hdr"), bad}), "", *mpirun(3));
        CHECK(wrong.status == 1);
        CHECK(wrong.err.starts_with(bad + ":1: "));
        CHECK(std::count(wrong.err.begin(), wrong.err.end(), '\n') == 1);
    }
    const ProgramResult usage = run_program(line({"-bogus", bad}), "", *mpirun(3));
    CHECK(usage.status == 2);
    CHECK(std::count(usage.err.begin(), usage.err.end(), '\n') == 2);  // with "Try ..."
}

TEST_CASE("render and trace on ranks: standard output that cannot be written is an error") {
    if (!have_mpi() || !std::filesystem::exists("/dev/full")) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const auto into = [&](const std::string& file, const std::vector<std::string>& words,
                          const std::string& input) {
        std::vector<std::string> launcher{"sh", "-c", "exec \"$@\" >" + file, "sh"};
        const std::vector<std::string> ranks = *mpirun(2);
        launcher.insert(launcher.end(), ranks.begin(), ranks.end());
        return run_program(words, input, launcher);
    };
    const std::string ray = "0 0 3 0 0 -1\n", file = folder.path("out");
    const std::vector<std::string> rays{"trace", "-h", "-n", "1", scene};
    for (const auto& [words, input] :
         {std::pair{line({"-n", "1", scene}), std::string()}, {rays, ray}}) {
        CAPTURE(words[0]);
        const ProgramResult full = into("/dev/full", words, input);
        CHECK(full.status == 1);
        CHECK(full.err.find("cannot write standard output") != std::string::npos);
        // What is there stays, and what comes is whole.
        (void)folder.write("out", "before\n");
        const ProgramResult good = into("> " + file, words, input);
        CHECK(good.status == 0);
        CHECK(good.err.empty());
        const ProgramResult piped = run_program(words, input, *mpirun(2));
        CHECK(pixel_bytes(piped.out) == pixel_bytes(read_whole(file)));
        CHECK(read_whole(file).starts_with("before\n"));
        CHECK(piped.out.size() + 7 == read_whole(file).size());
    }
}

TEST_CASE("render: copies that a launcher starts without MPI are warned of, once") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const auto copy = [&](const std::string& rank) {
        return run_program(line({"-x", "8", "-y", "8", "-o", folder.path("out.hdr"), scene}), "",
                           {"env", "SLURM_STEP_NUM_TASKS=4", "SLURM_PROCID=" + rank});
    };
    CHECK(copy("0").err.find("4 processes were started that do not know of each other") !=
          std::string::npos);
    CHECK(copy("1").err.empty());
}

TEST_CASE("render: one process keeps a timeline, too") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string file = folder.path("timeline.json"), out = folder.path("out.hdr");
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{}, {"--variant", "threads"}}) {
        std::filesystem::remove(file);
        REQUIRE(run_program(line({"-ps", "1", "-o", out, scene})).status == 0);
        const std::string expected = pixel_bytes(read_whole(out));
        const ProgramResult result = run_program(
            line(with(more, {"-ps", "1", "-n", "2", "--timeline", file, "-o", out, scene})));
        CHECK(result.err.empty());
        CHECK(result.status == 0);
        CHECK(pixel_bytes(read_whole(out)) == expected);
        REQUIRE(std::filesystem::exists(file));
        CHECK(figure(file, "/traceEvents") > 4);
    }
}
