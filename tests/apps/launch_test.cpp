// lightwalk launch: pictures survive the loss of ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/child_process.h"
#include "apps/launch_hosts.h"
#include "tests/apps/program.h"
#include "tests/apps/rank_runs.h"
#include "tests/temporary_folder.h"

namespace lightwalk::test {
namespace {

using namespace rank_runs;

/// What mpirun needs here: what stands before it, and behind it but for the number of ranks.
struct MpirunNeeds {
    std::vector<std::string> environment;
    std::string options;
};

MpirunNeeds mpirun_needs() {
    const std::vector<std::string> all = *mpirun(1);
    const auto at = std::find(all.begin(), all.end(), "mpirun");
    MpirunNeeds needs{{all.begin(), at}, {}};
    for (auto word = at + 1; word != all.end(); ++word) {
        if (*word == "-n")
            ++word;  // launch says how many
        else
            needs.options += *word + ' ';
    }
    return needs;
}

std::vector<std::string> launch(const std::vector<std::string>& options,
                                const std::vector<std::string>& command) {
    std::vector<std::string> words{"launch", "--ranks", "3", "--mpirun", mpirun_needs().options};
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), command.begin(), command.end());
    return words;
}

}  // namespace

TEST_CASE("launch: a picture survives ranks that are killed, and is the same") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::string> slow = with(kLongRun, {"-n", "1", "--variant", "ranks"});
    const std::string out = folder.path("out.hdr"), kept = folder.path("blocks");
    REQUIRE(run_program(line(with(kLongRun, {"-o", folder.path("whole.hdr"), scene}))).status == 0);
    RunningProgram program(
        launch({"--retries", "9"}, line(with(slow, {"--checkpoint", kept, "-o", out, scene}))),
        mpirun_needs().environment);
    int killed = 0;
    for (std::vector<int> before; killed < 2 && !std::filesystem::exists(out);) {
        std::vector<int> ranks;
        const auto others_run = [&] {
            ranks = ranks_with(kept);
            return std::filesystem::exists(out) ||
                   (ranks.size() == 3 && ranks != before && std::filesystem::exists(kept));
        };
        if (!comes_true(others_run)) FAIL("the ranks do not start");
        if (std::filesystem::exists(out)) break;
        killed += kill(ranks[static_cast<std::size_t>(killed)], SIGKILL) == 0;
        before = ranks;
    }
    const ProgramResult result = program.finish();
    CAPTURE(result.err);
    CHECK(result.status == 0);
    if (killed > 0) CHECK(result.err.find("goes on (1 of 9)") != std::string::npos);
    CHECK(pixel_bytes(read_whole(out)) == pixel_bytes(read_whole(folder.path("whole.hdr"))));
}

TEST_CASE("launch: what a command ends with by itself is no loss") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string kept = folder.path("blocks"), out = folder.path("out.hdr");
    const ProgramResult missing =
        run_program(launch({}, line({"--checkpoint", kept, "-o", out, folder.path("missing.rad")})),
                    "", mpirun_needs().environment);
    CHECK(missing.status == 1);
    CHECK(missing.err.find("cannot open") != std::string::npos);
    CHECK(missing.err.find("goes on") == std::string::npos);
    CHECK_FALSE(std::filesystem::exists(out));
}

TEST_CASE("launch: an mpirun that hangs when its ranks have ended is killed, and the run goes on") {
    const TemporaryFolder folder;
    const std::string begun = folder.path("begun");
    // What a shell has started, and leaves to a program that asks for no ends of children.
    folder.write("mpirun", "#!/bin/sh\n[ -e '" + begun + "' ] && exit 0\n: > '" + begun +
                               "'\ntrue &\nexec sleep 600\n");
    std::filesystem::permissions(folder.path("mpirun"), std::filesystem::perms::owner_all);
    const std::vector<std::string> path{
        "env", "PATH=" + folder.path() + ':' + std::getenv("PATH")};  // NOLINT: nobody writes it
    const std::vector<std::string> render{"render", "--checkpoint",         folder.path("blocks"),
                                          "-o",     folder.path("out.hdr"), "room.rad"};
    const ProgramResult gone_on = run_program(with({"launch", "--retries", "1"}, render), "", path);
    CAPTURE(gone_on.err);
    CHECK(gone_on.status == 0);
    CHECK(gone_on.err.find("mpirun hung when its ranks had ended") != std::string::npos);
    CHECK(gone_on.err.find("goes on (1 of 1)") != std::string::npos);
}

TEST_CASE("unheeded ends: a process whose children come and go heeds them") {
    RunningProgram shell({}, {"sh", "-c", "while :; do /bin/true; done"});
    UnheededEnds ends;
    using Clock = std::chrono::steady_clock;
    for (const auto end = Clock::now() + std::chrono::seconds(1); Clock::now() < end;)
        REQUIRE_FALSE(ends.seen(shell.process()));
}

TEST_CASE("launch: mistakes are told before anything is started") {
    const TemporaryFolder folder;
    const auto said = [&](const std::vector<std::string>& words, int status) {
        const ProgramResult result = run_program(words);
        CAPTURE(result.err);
        CHECK(result.status == status);
        return result.err;
    };
    CHECK(said({"launch", "render", "room.rad"}, 2).find("--checkpoint") != std::string::npos);
    CHECK(said({"launch"}, 2).find("expected a command") != std::string::npos);
    CHECK(said({"launch", "info", "room.rad"}, 2).find("expected a command") != std::string::npos);
    CHECK(said({"launch", "--rank", "3", "render"}, 2).find("--ranks") != std::string::npos);
    CHECK(said({"launch", "walk", "--port", "99999", "room.rad"}, 2).find("--port") !=
          std::string::npos);
    CHECK(said({"launch", "walk", "--bind", "nowhere", "room.rad"}, 1)
              .find("nowhere:8080: expected an address in numbers") != std::string::npos);
    const std::string hosts = folder.write("hosts", "# two\nfirst slots=2\nsecond cores=2\n");
    CHECK(said({"launch", "--hosts", hosts, "animate", "room.rad"}, 1)
              .find(hosts + ":3: expected NAME") != std::string::npos);
    const std::string none = folder.write("none", "# nothing\n");
    CHECK(said({"launch", "--hosts", none, "animate", "room.rad"}, 1).find("names no host") !=
          std::string::npos);
}

TEST_CASE(
    "launch: a host is one that answers, and a file of hosts that changes is looked at again") {
    const TemporaryFolder folder;
    const LaunchHosts all{{"127.0.0.1", 2}, {"nowhere.invalid", 1}};
    const LaunchHosts there{all.front()};
    CHECK(answering(all, std::chrono::seconds(5)) == there);
    const std::string file = folder.write("hosts", "127.0.0.1 slots=2\nnowhere.invalid\n");
    REQUIRE(read_launch_hosts(file) == all);
    HostWatch watch(file, there);
    folder.write("hosts", "localhost slots=3\n127.0.0.1 slots=2\n");
    const LaunchHosts more{{"localhost", 3}, {"127.0.0.1", 2}};
    REQUIRE(comes_true([&] { return watch.better().has_value(); }));
    CHECK(watch.better() == more);
    watch.use(more);
    CHECK_FALSE(watch.better());
    folder.write("hosts", "localhost\n");
    REQUIRE(comes_true([&] { return watch.better().has_value(); }));
    CHECK(watch.better() == LaunchHosts{{"localhost", 1}});
}

}  // namespace lightwalk::test
