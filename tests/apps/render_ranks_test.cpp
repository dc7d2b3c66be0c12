// lightwalk render on ranks, started by mpirun.
#include <doctest/doctest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/rank_runs.h"

using namespace lightwalk::test;
using namespace lightwalk::test::rank_runs;

TEST_CASE("render on ranks: the bytes of one process, for every split") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::vector<std::string>> all_options{
        {"-ps", "1", "-dj", ".5", "-z", folder.path("one.z")},
        {"-ps", "4", "-pt", ".05"},
        {"--samples", "3", "-dj", ".5"},
        {"--samples", "2", "--pixel-filter", "mitchell", "-dj", ".5"},
        {"--error", ".1", "-dj", ".5"}};
    for (std::size_t i = 0; i < all_options.size(); ++i) {
        const std::vector<std::string>& options = all_options[i];
        CAPTURE(options[1]);
        const ProgramResult alone =
            run_program(line(with(options, {"-n", "2", "-o", folder.path("one.hdr"), scene})));
        REQUIRE(alone.status == 0);
        const std::string expected = pixel_bytes(read_whole(folder.path("one.hdr")));
        for (std::size_t k = 0; k < kSplits.size(); ++k) {
            if (!kEachWithAllOptions && k % all_options.size() != i) continue;
            const Split& split = kSplits[k];
            CAPTURE(split.ranks);
            const std::string out = folder.path("ranks.hdr");
            std::filesystem::remove(out);
            std::vector<std::string> words = with(options, split.options);
            if (words.size() > 4 && words[4] == "-z") words[5] = folder.path("ranks.z");
            const ProgramResult shared = run_program(line(with(words, {"-o", out, scene})), "",
                                                     *mpirun(split.ranks, split.mpi));
            CHECK(shared.err.empty());
            REQUIRE(shared.status == 0);
            CHECK(pixel_bytes(read_whole(out)) == expected);
            if (options.back() == folder.path("one.z"))
                CHECK(read_whole(folder.path("ranks.z")) == read_whole(folder.path("one.z")));
        }
    }
}

TEST_CASE(
    "render on ranks: pictures of a sequence follow each other without a pause, and are right") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string views =
        "rview -vp 0 -6 2\nrview -vp .5 -6 2\nrview -vp 1 -6 2 -vd -.1 1 -.2\nrview -vp 1 -5 2\n";
    const auto run = [&](const std::string& name, const std::vector<std::string>& options,
                         const std::vector<std::string>& launcher) {
        const std::string out = folder.path(name + "%d.hdr");
        const ProgramResult result =
            run_program(line(with(options, {"-ps", "1", "-pm", ".5", "-S", "1", "-o", out, scene})),
                        views, launcher);
        CHECK(result.status == 0);
        CHECK(result.err.empty());
        std::string all;
        for (const char* number : {"1", "2", "3", "4"})
            all += pixel_bytes(read_whole(folder.path(name + number + ".hdr")));
        return all;
    };
    const std::string expected = run("alone", {"-n", "1"}, {});
    CHECK(run("ranks", {"--variant", "ranks"}, *mpirun(4)) == expected);
    CHECK(run("hybrid", {"-n", "2"}, *mpirun(2)) == expected);
}

TEST_CASE("render on ranks: ambient values are exchanged, and kept in the file of rank 0") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string stats = folder.path("stats.json");
    const std::vector<std::string> light{"-ab", "1",   "-ad", "64",      "-as", "0",  "-ps",
                                         "1",   "-aa", ".1",  "--stats", stats, "-n", "1"};
    const auto values = [&](const std::vector<std::string>& options, int ranks) {
        const ProgramResult result =
            run_program(line(with(with(light, options), {"-o", folder.path("a.hdr"), scene})), "",
                        *mpirun(ranks));
        CHECK(result.err.empty());
        REQUIRE(result.status == 0);
        return nlohmann::json::parse(read_whole(stats))["ambient"]["computed"].get<int>();
    };
    const auto messages_with_values = [&] {
        int count = 0;
        const auto told = nlohmann::json::parse(read_whole(stats));
        for (const auto& rank : told["per_rank"])
            if (rank["messages"].contains("AmbientValues"))
                count += rank["messages"]["AmbientValues"]["count"].get<int>();
        return count;
    };
    // A value takes a millisecond and more, so that the others' arrive while there is work left.
    const std::vector<std::string> slow{"-ad", "512", "--variant", "ranks"};
    const int apart = values(with(slow, {"--ambient-batch", "0"}), 5);
    CHECK(messages_with_values() == 0);
    const int shared = values(with(slow, {"--ambient-batch", "2"}), 6);
    CHECK(messages_with_values() > 0);
    CHECK(shared < apart);
    const std::string file = folder.path("room.amb");
    const int first = values({"--variant", "ranks", "-af", file}, 4);
    CHECK(first > 0);
    CHECK(values({"--variant", "ranks", "-af", file}, 4) < first / 4);
    CHECK(values({"--variant", "hybrid", "-af", file}, 2) < first / 4);
}

TEST_CASE("render on ranks: what is wrong is said once, by rank 0, and nothing hangs") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string out = folder.path("none.hdr");
    const std::string bad = folder.write("bad.rad", "void plastic p 0 0 5 1 1 one 0 0\n");
    const auto run = [&](const std::vector<std::string>& words) {
        return run_program(line(with(words, {"-o", out, bad})), "", *mpirun(3));
    };
    const ProgramResult wrong = run({"--variant", "ranks"});
    CHECK(wrong.status == 1);
    CHECK(wrong.err.find(bad + ":1: ") != std::string::npos);
    CHECK(wrong.err.find(bad + ":1: ") == wrong.err.rfind(bad + ":1: "));
    CHECK(run({"--variant", "rnks"}).status == 2);
    CHECK(run({"--variant", "threads"}).status == 2);
    CHECK(run({"--masters", "7"}).status == 1);
    CHECK_FALSE(std::filesystem::exists(out));
    const ProgramResult alone = run_program(line({"--variant", "ranks", "-o", out, bad}));
    CHECK(alone.status == 2);
    CHECK(alone.err.find("mpirun") != std::string::npos);
}

TEST_CASE("render on ranks: an error while tracing names its rank") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom + R"(
void brightfunc missing 2 nothing nowhere.cal 0 0
missing plastic lost 0 0 5 .5 .5 .5 0 0
lost sphere near 0 0 4 1.5 -1 1 .5
)");
    const ProgramResult result = run_program(
        line({"--variant", "ranks", "-ps", "1", "-w-", "-o", folder.path("none.hdr"), scene}), "",
        *mpirun(3));
    CHECK(result.status == 1);
    CHECK(result.err.find("nowhere.cal") != std::string::npos);
    CHECK(result.err.find("rank ") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.path("none.hdr")));
}

TEST_CASE(
    "render: a run that is killed goes on from its checkpoint, with any split, to the same bytes") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::string>& slow = kLongRun;
    const std::string checkpoint = folder.path("blocks");
    const ProgramResult whole =
        run_program(line(with(slow, {"-o", folder.path("whole.hdr"), scene})));
    REQUIRE(whole.status == 0);
    const std::string expected = pixel_bytes(read_whole(folder.path("whole.hdr")));
    const std::string out = folder.path("out.hdr");
    const std::vector<std::string> kept{"--checkpoint", checkpoint, "-o", out, scene};
    {
        RunningProgram program(line(with(slow, with({"-n", "1"}, kept))));
        REQUIRE(comes_true([&] { return holds_blocks(checkpoint); }));
    }  // killed
    CHECK_FALSE(std::filesystem::exists(out));
    REQUIRE(std::filesystem::exists(checkpoint));
    // Not by accident, and not by another run.
    const ProgramResult again = run_program(line(with(slow, kept)));
    CHECK(again.status == 1);
    CHECK(again.err.find("--resume") != std::string::npos);
    const ProgramResult other =
        run_program(line(with(with(slow, {"--resume", "-dj", ".3"}), kept)));
    CHECK(other.status == 1);
    CHECK(other.err.find("belongs to another run") != std::string::npos);
    if (mpirun(1)) {
        const std::string copy = folder.write("copy", read_whole(checkpoint));
        std::vector<std::string> words = with(with(slow, {"--resume"}), kept);
        words[words.size() - 4] = copy;
        const ProgramResult ranks = run_program(line(words), "", *mpirun(3));
        CHECK(beside_cut(ranks.err).empty());
        CHECK(pixel_bytes(read_whole(out)) == expected);
        std::filesystem::remove(out);
    }
    const ProgramResult rest = run_program(line(with(with(slow, {"--resume", "-n", "1"}), kept)));
    CHECK(rest.status == 0);
    CHECK(pixel_bytes(read_whole(out)) == expected);
    CHECK_FALSE(std::filesystem::exists(checkpoint));
}

TEST_CASE("render: a run with indirect light that is killed goes on from the values it had") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string checkpoint = folder.path("blocks"), values = checkpoint + "-ambient";
    const std::string out = folder.path("out.hdr"), stats = folder.path("stats.json");
    const std::vector<std::string> light{"-x",  kLitWidth, "-y",  kLitHeight, "-ps", "1",   "-ab",
                                         "1",   "-ad",     "64",  "-as",      "0",   "-aa", ".1",
                                         "-w-", "--stats", stats, "-o",       out,   scene};
    const auto computed = [&](const std::vector<std::string>& more) {
        const ProgramResult result = run_program(line(with(more, light)));
        CHECK(result.status == 0);
        CHECK(beside_cut(result.err).empty());
        return nlohmann::json::parse(read_whole(stats))["ambient"]["computed"].get<int>();
    };
    const int whole = computed({});
    std::filesystem::remove(out);
    {
        RunningProgram program(line(with({"-n", "1", "--checkpoint", checkpoint}, light)));
        REQUIRE(comes_true([&] { return holds_blocks(checkpoint); }));
    }  // killed
    CHECK_FALSE(std::filesystem::exists(out));
    REQUIRE(std::filesystem::exists(values));
    const ProgramResult again = run_program(line(with({"--checkpoint", checkpoint}, light)));
    CHECK(again.status == 1);
    CHECK(again.err.find(values) != std::string::npos);
    CHECK(computed({"--checkpoint", checkpoint, "--resume"}) < whole / 2);
    CHECK(std::filesystem::exists(out));
    CHECK_FALSE(std::filesystem::exists(checkpoint));
    CHECK_FALSE(std::filesystem::exists(values));
    // A deterministic run keeps them in the checkpoint.
    (void)computed({"--deterministic", "-x", "60", "-y", "40", "--checkpoint", checkpoint});
    CHECK_FALSE(std::filesystem::exists(values));
}

TEST_CASE("render on ranks: a rank that is killed ends the run at once, and it can be resumed") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::string> slow = with(kLongRun, {"-n", "1"});
    const ProgramResult whole =
        run_program(line(with(slow, {"-o", folder.path("whole.hdr"), scene})));
    REQUIRE(whole.status == 0);
    const std::string out = folder.path("out.hdr");
    const std::string checkpoint = folder.path("blocks");
    const auto command = [&](const std::vector<std::string>& more) {
        return line(with(slow, with(more, {"--variant", "ranks", "--checkpoint", checkpoint, "-o",
                                           out, scene})));
    };
    // A run whose picture is there when a rank dies is not followed by another: that one would have
    // to be stopped from outside, and what it leaves running would meet the last run's checkpoint.
    for (std::size_t victim = 0; victim < 4 && !std::filesystem::exists(out); ++victim) {
        CAPTURE(victim);
        RunningProgram program(command({"--resume"}), *mpirun(4));
        std::vector<int> ranks;
        if (!comes_true([&] {
                ranks = ranks_with(checkpoint);
                return ranks.size() == 4 || std::filesystem::exists(out);
            }))
            FAIL("the ranks do not start");
        std::this_thread::sleep_for(std::chrono::milliseconds(150 + 100 * victim));
        if (ranks.size() == 4) kill(ranks[victim], SIGKILL);
        const auto begin = std::chrono::steady_clock::now();
        const ProgramResult result = program.finish();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        CAPTURE(result.err);
        CHECK(took.count() < 60);  // one second, on a machine that has nothing else to do
        if (std::filesystem::exists(out)) continue;  // it was quicker
        CHECK(result.status != 0);
        if (!launcher_died(result)) CHECK(result.err.find("rank") != std::string::npos);
    }
    std::filesystem::remove(out);
    const ProgramResult rest = run_program(command({"--resume"}), "", *mpirun(3));
    CHECK(rest.status == 0);
    CHECK(pixel_bytes(read_whole(out)) == pixel_bytes(read_whole(folder.path("whole.hdr"))));
}
