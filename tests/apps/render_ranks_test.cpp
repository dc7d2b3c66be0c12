// lightwalk render on ranks, started by mpirun.
#include <doctest/doctest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 .1 .1
void glass pane 0 0 3 .9 .9 .9
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
floor sphere ball 0 0 4 0 0 1 1
pane polygon window 0 0 12  -2 -3 0  2 -3 0  2 -3 3  -2 -3 3
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";

std::vector<std::string> line(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "-vp", "0",  "-6", "2",   "-vd", "0",   "1", "-.2",
                                   "-x",     "90",  "-y", "60", "-vh", "45",  "-vv", "31"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::string pixel_bytes(const std::string& picture) {
    const std::size_t begin = picture.find("\n\n");
    return begin == std::string::npos ? std::string() : picture.substr(begin);
}

bool have_mpi() {
    if (mpirun(1)) return true;
    MESSAGE("skipped: no mpirun here");
    return false;
}

struct Split {
    int ranks = 1;
    std::vector<std::string> options, mpi;
};
// Under AddressSanitizer it is to start that takes a rank its time; few ranks run the same code.
#if defined(__SANITIZE_ADDRESS__)
constexpr int kMany = 4, kMore = 5;
constexpr bool kEachWithAllOptions = false;
#else
constexpr int kMany = 9, kMore = 16;
constexpr bool kEachWithAllOptions = true;
#endif
const std::vector<Split> kSplits{
    {3, {"--variant", "ranks"}, {}},
    {4, {"--variant", "ranks", "--stride", "1"}, {"--mca", "btl", "self,tcp"}},
    {kMany, {"--variant", "ranks", "--block", "16"}, {}},
    {kMore, {"--variant", "ranks", "--masters", "3"}, {}},
    {1, {"-n", "2"}, {}},
    {2, {"--variant", "hybrid", "-n", "1"}, {}},
    {2, {"-n", "2"}, {}},
    {4, {"-n", "2", "--masters", "2"}, {}}};

// So long that a run can be killed before it ends: under AddressSanitizer a quarter of the pixels
// takes longer than all of them elsewhere.
#if defined(__SANITIZE_ADDRESS__)
const std::vector<std::string> kLongRun{"-x", "450", "-y", "300", "-ps", "1"};
const std::string kLitWidth = "300", kLitHeight = "225";
#else
const std::vector<std::string> kLongRun{"-x", "900", "-y", "600", "-ps", "1"};
const std::string kLitWidth = "600", kLitHeight = "450";
#endif

// Indirect light in rounds.
const std::vector<std::string> kRoundsRun{"-ps",
                                          "1",
                                          "-ab",
                                          "2",
                                          "-ad",
                                          "32",
                                          "-as",
                                          "0",
                                          "-aa",
                                          ".3",
                                          "-ar",
                                          "16",
                                          "-av",
                                          ".01",
                                          ".01",
                                          ".01",
                                          "--deterministic"};

/// Whether it comes true within a minute.
bool comes_true(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

/// Whether there is more in a checkpoint than what it begins with.
/// @param least  bytes
bool holds_blocks(const std::string& checkpoint, std::uintmax_t least = 4000) {
    std::error_code none;
    const std::uintmax_t size = std::filesystem::file_size(checkpoint, none);
    return !none && size > least;
}

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace

TEST_CASE("render on ranks: the bytes of one process, for every split") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::vector<std::string>> all_options{
        {"-ps", "1", "-dj", ".5", "-z", folder.path("one.z")},
        {"-ps", "4", "-pt", ".05"},
        {"--samples", "3", "-dj", ".5"},
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

TEST_CASE("render on ranks: --deterministic gives the bytes of one process with indirect light") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::string> options{"-ps",
                                           "1",
                                           "-ab",
                                           "2",
                                           "-ad",
                                           "32",
                                           "-as",
                                           "0",
                                           "-aa",
                                           ".3",
                                           "-ar",
                                           "16",
                                           "-av",
                                           ".01",
                                           ".01",
                                           ".01",
                                           "--deterministic"};
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
    for (const Split& split : kSplits) {
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
    for (const Split& split : kSplits) {
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
        std::vector<std::string> launcher{"sh", "-c", "exec \"$@\" > " + file, "sh"};
        for (const std::string& word : *mpirun(2)) launcher.push_back(word);
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
        CHECK(nlohmann::json::parse(read_whole(file))["traceEvents"].size() > 4);
    }
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
        CHECK(ranks.err.empty());
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
        CHECK(result.err.empty());
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
        CHECK(result.err.empty());
        return nlohmann::json::parse(read_whole(stats))["ambient"]["computed"].get<int>();
    };
    const int whole = computed({});
    const std::string expected = pixel_bytes(read_whole(out));
    std::filesystem::remove(out);
    {
        RunningProgram program(line(with({"-n", "1", "--checkpoint", checkpoint}, light)));
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
        (void)folder.write("blocks", kept);
        CHECK(computed(with(resumed, split.options), *mpirun(split.ranks)) < whole);
        CHECK(pixel_bytes(read_whole(out)) == expected);
    }
}

namespace {

/// Processes that run the program with this word on their command lines, but for those that start
/// others.
std::vector<int> ranks_with(const std::string& word) {
    std::vector<int> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string words = read_whole(entry.path() / "cmdline");
        if (words.starts_with(LIGHTWALK_PROGRAM) && words.find(word) != std::string::npos)
            found.push_back(std::stoi(name));
    }
    return found;
}

}  // namespace

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
