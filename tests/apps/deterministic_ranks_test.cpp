// --deterministic: the same values, by any division, also beside other runs and after a crash.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/rank_runs.h"
#include "tests/one_thread.h"

using namespace lightwalk::test;
using namespace lightwalk::test::rank_runs;

namespace {

/// What starts a program to which a read-only file is one, also where root runs the tests.
std::vector<std::string> without_privilege() {
    if (geteuid() != 0) return {};
    return {"/usr/bin/setpriv", "--bounding-set", "-dac_override"};
}

}  // namespace

TEST_CASE("render on ranks: --deterministic gives the bytes of one process with indirect light") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::string>& options = kRoundsRun;
    const auto render = [&](const std::string& name, const std::vector<std::string>& more,
                            const std::vector<std::string>& launcher) {
        const std::string out = folder.path(name);
        const ProgramResult result =
            run_program(line(with(with(options, more), {"-o", out, scene})), "", launcher);
        CHECK(result.err.empty());
        CHECK(result.status == 0);
        return pixel_bytes(read_whole(out));
    };
    const std::string alone = render("one.hdr", {"-n", "1"}, {});
    CHECK(render("two.hdr", {"-n", "2"}, {}) == alone);
    for (const Split& split : kRoundSplits) {
        CAPTURE(split.ranks);
        CHECK(render("ranks.hdr", split.options, *mpirun(split.ranks, split.mpi)) == alone);
    }
    // Values of an ambient file, which rank 0 reads, are where all begin.
    const std::string file = folder.path("room.amb");
    (void)render("coarse.hdr", {"-n", "1", "-x", "20", "-y", "20", "-af", file}, {});
    std::filesystem::copy_file(file, folder.path("again.amb"));
    const std::string after = render("one.hdr", {"-n", "1", "-af", folder.path("again.amb")}, {});
    CHECK(after != alone);
    CHECK(render("ranks.hdr", {"-n", "2", "-af", file}, *mpirun(2)) == after);
}

TEST_CASE(
    "render on ranks: what --deterministic computes is kept in an ambient file by any split") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const auto words = [&](const std::string& name, const std::vector<std::string>& more) {
        return line(with(with(kRoundsRun, more), {"-af", folder.path(name + ".amb"), "-o",
                                                  folder.path(name + ".hdr"), scene}));
    };
    REQUIRE(run_program(words("one", {"-n", "1"})).status == 0);
    const std::string values = read_whole(folder.path("one.amb"));
    const std::string picture = pixel_bytes(read_whole(folder.path("one.hdr")));
    CHECK(values.size() > 10000);
    for (const Split& split : kRoundSplits) {
        CAPTURE(split.ranks);
        std::filesystem::remove(folder.path("ranks.amb"));
        const ProgramResult result =
            run_program(words("ranks", split.options), "", *mpirun(split.ranks, split.mpi));
        CHECK(result.err.empty());
        REQUIRE(result.status == 0);
        CHECK(read_whole(folder.path("ranks.amb")) == values);
        CHECK(pixel_bytes(read_whole(folder.path("ranks.hdr"))) == picture);
    }
}

TEST_CASE("render on ranks: deterministic runs that share an ambient file leave each other alone") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string file = folder.path("shared.amb");
    const auto words = [&](const std::string& out, const std::vector<std::string>& more) {
        return line(with(with(kRoundsRun, more), {"-o", folder.path(out), scene}));
    };
    REQUIRE(run_program(words("alone.hdr", {})).status == 0);
    const std::string alone = pixel_bytes(read_whole(folder.path("alone.hdr")));
    // The other one adds its values while this one is between two rounds.
    (void)folder.write("shared.amb", "");
    const std::vector<std::string> shares{"-n", "1", "-af", file};
    RunningProgram first(words("first.hdr", shares), *mpirun(2));
    RunningProgram second(words("second.hdr", shares), *mpirun(2));
    RunningProgram third(words("third.hdr", shares));
    for (RunningProgram* program : {&first, &second, &third}) {
        const ProgramResult result = program->finish();
        CHECK(result.err.empty());
        CHECK(result.status == 0);
    }
    // Who found the file empty has drawn the picture of a run by itself; another one may have begun
    // later. None has what came while it ran.
    int same = 0;
    for (const char* out : {"first.hdr", "second.hdr", "third.hdr"})
        same += pixel_bytes(read_whole(folder.path(out))) == alone ? 1 : 0;
    CHECK(same > 0);
}

TEST_CASE("render: a deterministic run that is killed goes on with its rounds, with any split") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string checkpoint = folder.path("blocks"), out = folder.path("out.hdr");
    const std::string stats = folder.path("stats.json");
    const std::vector<std::string> light{
        "-x",  kLitWidth, "-y",      kLitHeight, "-ps", "1",  "-ab", "2",
        "-ad", "256",     "-as",     "0",        "-aa", ".1", "-w-", "--deterministic",
        "-o",  out,       "--stats", stats,      scene};
    const auto computed = [&](const std::vector<std::string>& more,
                              const std::vector<std::string>& launcher = {}) {
        const ProgramResult result = run_program(line(with(more, light)), "", launcher);
        CHECK(result.status == 0);
        CHECK(beside_cut(result.err).empty());
        return figure(stats, "/ambient/computed");
    };
    const int whole = computed({});
    const std::string expected = pixel_bytes(read_whole(out));
    const std::vector<std::string> resumed{"--checkpoint", checkpoint, "--resume"};
    std::string kept;
    // What is killed in the midst of its first values' record has kept none of them.
    for (std::size_t least = 200000, none = 0;; least += 200000, ++none) {
        REQUIRE(none < 4);
        std::filesystem::remove(out);
        {
            RunningProgram program(line(with({"-n", "1", "--checkpoint", checkpoint}, light)));
            REQUIRE(comes_true([&] { return holds_blocks(checkpoint, least); }));
        }  // killed
        REQUIRE_FALSE(std::filesystem::exists(out));
        kept = read_whole(checkpoint);
        const int rest = computed(resumed);
        CHECK(pixel_bytes(read_whole(out)) == expected);
        if (rest < whole) break;
        CHECK(rest == whole);
    }
    CHECK_FALSE(std::filesystem::exists(checkpoint));
    if (!mpirun(1)) return;
    for (const Split& split : {kSplits[0], kSplits[6]}) {
        CAPTURE(split.ranks);
        (void)folder.write("blocks", kept);
        CHECK(computed(with(resumed, split.options), *mpirun(split.ranks)) < whole);
        CHECK(pixel_bytes(read_whole(out)) == expected);
    }
}

TEST_CASE("render: rounds go on where a file keeps their values, which has grown since" *
          about_numbers) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string checkpoint = folder.path("blocks"), out = folder.path("out.hdr");
    const std::string stats = folder.path("stats.json"), values = folder.path("room.amb");
    const std::vector<std::string> light{
        "-ps", "1",   "-ab", "2", "-ad", "256", "-as", "0", "-aa", ".1", "--deterministic",
        "-af", values};
    const std::vector<std::string> picture =
        with(light, {"-x", kLitWidth, "-y", kLitHeight, "-o", out, "--stats", stats, scene});
    const auto computed = [&](const std::vector<std::string>& more, const std::string& said = {},
                              const std::vector<std::string>& launcher = {}) {
        const ProgramResult result = run_program(line(with(more, picture)), "", launcher);
        CHECK(result.status == 0);
        if (said.empty())
            CHECK(beside_cut(result.err).empty());
        else
            CHECK(result.err.find(said) != std::string::npos);
        return figure(stats, "/ambient/computed");
    };
    // Values of an earlier run are where all begin.
    REQUIRE(run_program(line(with(light, {"-x", "15", "-y", "10", "-o", out, scene}))).status == 0);
    const std::string before = read_whole(values);
    const int whole = computed({});
    const std::string expected = pixel_bytes(read_whole(out)), all = read_whole(values);
    (void)folder.write("room.amb", before);
    std::filesystem::remove(out);
    {
        RunningProgram program(line(with({"-n", "1", "--checkpoint", checkpoint}, picture)));
        REQUIRE(comes_true([&] { return holds_blocks(checkpoint, 200000); }));
    }  // killed
    REQUIRE_FALSE(std::filesystem::exists(out));
    const std::string kept = read_whole(checkpoint), grown = read_whole(values);
    REQUIRE(grown.size() > before.size());
    const std::vector<std::string> resumed{"--checkpoint", checkpoint, "--resume"};
    CHECK(computed(resumed) < whole);
    CHECK(pixel_bytes(read_whole(out)) == expected);
    CHECK(read_whole(values) == all);
    CHECK_FALSE(std::filesystem::exists(checkpoint));
    // It has other values than before: what was kept is of no use.
    const auto restore = [&](const std::string& file) {
        (void)folder.write("blocks", kept);
        (void)folder.write("room.amb", file);
    };
    restore(before.substr(0, before.size() / 2));
    (void)computed(resumed, "begins anew");
    restore({});
    (void)computed(resumed, "begins anew");
    if (!mpirun(1)) return;
    for (const Split& split : {kSplits[0], kSplits[6]}) {
        CAPTURE(split.ranks);
        restore(grown);
        CHECK(computed(with(resumed, split.options), {}, *mpirun(split.ranks)) < whole);
        CHECK(pixel_bytes(read_whole(out)) == expected);
        CHECK(read_whole(values) == all);
    }
}

TEST_CASE("render: rounds go on where a file gives them values, and takes none" * about_numbers) {
    if (geteuid() == 0 && !std::filesystem::exists(without_privilege().front())) {
        MESSAGE("skipped: root may write all files here");
        return;
    }
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string checkpoint = folder.path("blocks"), out = folder.path("out.hdr");
    const std::string stats = folder.path("stats.json"), values = folder.path("room.amb");
    const std::vector<std::string> light{
        "-ps", "1",   "-ab", "2", "-ad", "256", "-as", "0", "-aa", ".1", "--deterministic",
        "-af", values};
    const std::vector<std::string> picture =
        with(light, {"-x", kLitWidth, "-y", kLitHeight, "-o", out, "--stats", stats, scene});
    REQUIRE(run_program(line(with(light, {"-x", "15", "-y", "10", "-o", out, scene}))).status == 0);
    const std::string before = read_whole(values);
    std::filesystem::permissions(values, std::filesystem::perms::owner_read);
    const auto computed = [&](const std::vector<std::string>& more,
                              std::vector<std::string> launcher = {}) {
        std::vector<std::string> start = without_privilege();
        start.insert(start.end(), launcher.begin(), launcher.end());
        const ProgramResult result = run_program(line(with(more, picture)), "", start);
        CHECK(result.status == 0);
        CHECK(result.err.find("cannot be written; its values are used") != std::string::npos);
        const std::string said = beside_cut(result.err);
        CHECK(std::count(said.begin(), said.end(), '\n') == 1);
        CHECK(read_whole(values) == before);
        return figure(stats, "/ambient/computed");
    };
    const int whole = computed({});
    const std::string expected = pixel_bytes(read_whole(out));
    std::filesystem::remove(out);
    {
        RunningProgram program(line(with({"-n", "1", "--checkpoint", checkpoint}, picture)),
                               without_privilege());
        REQUIRE(comes_true([&] { return holds_blocks(checkpoint, 200000); }));
    }  // killed
    REQUIRE_FALSE(std::filesystem::exists(out));
    const std::string kept = read_whole(checkpoint);
    const std::vector<std::string> resumed{"--checkpoint", checkpoint, "--resume"};
    CHECK(computed(resumed) < whole);
    CHECK(pixel_bytes(read_whole(out)) == expected);
    CHECK_FALSE(std::filesystem::exists(checkpoint));
    if (!mpirun(1)) return;
    for (const Split& split : {kSplits[0], kSplits[6]}) {
        CAPTURE(split.ranks);
        // Also where it was killed in the midst of a record.
        (void)folder.write("blocks", kept.substr(0, kept.size() - 3));
        CHECK(computed(with(resumed, split.options), *mpirun(split.ranks)) < whole);
        CHECK(pixel_bytes(read_whole(out)) == expected);
    }
}

TEST_CASE("render: a deterministic sequence goes on where a file keeps its values" *
          about_numbers) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string views =
        "rview -vp 0 -6 2\nrview -vp 1 -6 2 -vd -.1 1 -.2\nrview -vp 3 -7 3 -vd -.4 1 -.3\n";
    const std::string checkpoint = folder.path("blocks"), values = folder.path("room.amb");
    const std::vector<std::string> light =
        with(kRoundsRun, {"-ad", "256", "-aa", ".15", "-af", values});
    const auto words = [&](const std::string& name, const std::vector<std::string>& more) {
        return line(with(with(light, {"-S", "1", "-x", "360", "-y", "240"}),
                         with(more, {"-o", folder.path(name + "%d.hdr"), scene})));
    };
    // Values of an earlier run are where all begin.
    REQUIRE(run_program(
                line(with(light, {"-x", "15", "-y", "10", "-o", folder.path("small.hdr"), scene})))
                .status == 0);
    const std::string before = read_whole(values);
    REQUIRE(run_program(words("whole", {}), views).status == 0);
    const std::string all = read_whole(values);
    REQUIRE(all.size() > before.size());
    (void)folder.write("room.amb", before);
    // A run that has drawn the first one, and is in the rounds of the second or the third one.
    {
        RunningProgram program(words("part", {"-n", "1", "--checkpoint", checkpoint}));
        program.send(views);
        program.end_input();
        REQUIRE(comes_true([&] { return std::filesystem::exists(folder.path("part1.hdr")); }));
    }                                                               // killed
    if (std::filesystem::exists(folder.path("part3.hdr"))) return;  // it was quicker
    const std::string kept = read_whole(checkpoint), grown = read_whole(values);
    CHECK(grown.size() > before.size());
    const std::vector<Split> splits{{1, {"-n", "2"}, {}}, kSplits[0], kSplits[6]};
    for (const Split& split : splits) {
        const bool alone = split.ranks == 1;
        if (!alone && !mpirun(1)) return;
        CAPTURE(split.ranks);
        (void)folder.write("blocks", kept);
        (void)folder.write("room.amb", grown);
        for (const char* number : {"2", "3"})
            std::filesystem::remove(folder.path("part" + std::string(number) + ".hdr"));
        const ProgramResult result = run_program(
            words("part", with({"--checkpoint", checkpoint, "--resume"}, split.options)), views,
            alone ? std::vector<std::string>{} : *mpirun(split.ranks));
        CHECK(beside_cut(result.err).empty());
        CHECK(result.status == 0);
        for (const char* number : {"1", "2", "3"}) {
            CAPTURE(number);
            CHECK(pixel_bytes(read_whole(folder.path("part" + std::string(number) + ".hdr"))) ==
                  pixel_bytes(read_whole(folder.path("whole" + std::string(number) + ".hdr"))));
        }
        CHECK(read_whole(values) == all);
        CHECK_FALSE(std::filesystem::exists(checkpoint));
    }
}

TEST_CASE("render: of a deterministic sequence that goes on, pictures begin with the same values") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string views = "rview -vp 0 -6 2\nrview -vp 1 -6 2 -vd -.1 1 -.2\n";
    const std::string checkpoint = folder.path("blocks");
    const auto words = [&](const std::string& name, const std::vector<std::string>& more) {
        return line(
            with(with(kRoundsRun, more), {"-S", "1", "-o", folder.path(name + "%d.hdr"), scene}));
    };
    // A run that has drawn the first one, and not all of the second one.
    {
        RunningProgram program(
            words("part", {"-n", "1", "--checkpoint", checkpoint, "-x", "360", "-y", "240"}));
        program.send(views);
        program.end_input();
        REQUIRE(comes_true([&] { return std::filesystem::exists(folder.path("part1.hdr")); }));
    }
    if (std::filesystem::exists(folder.path("part2.hdr"))) return;  // it was quicker
    REQUIRE(run_program(words("large", {"-x", "360", "-y", "240"}), views).status == 0);
    CHECK(run_program(
              words("part", {"--checkpoint", checkpoint, "--resume", "-x", "360", "-y", "240"}),
              views)
              .status == 0);
    for (const char* number : {"1", "2"})
        CHECK(pixel_bytes(read_whole(folder.path("part" + std::string(number) + ".hdr"))) ==
              pixel_bytes(read_whole(folder.path("large" + std::string(number) + ".hdr"))));
}
