// lightwalk animate on ranks, started by mpirun.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/program.h"
#include "tests/apps/walk_words.h"

using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 0 0
void plastic satin 0 0 5 .5 .4 .3 .05 .1
void mirror silver 0 0 3 .9 .9 .9
void glass pane 0 0 3 .9 .9 .9
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
satin sphere ball 0 0 4 0 0 1 1
silver polygon glass 0 0 12  2 3 0  5 3 0  5 3 3  2 3 3
pane polygon window 0 0 12  -3 -2 0  -1 -2 0  -1 -2 3  -3 -2 3
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
lamp sphere star 0 0 4  -2 2 3 .01
)";

bool have_mpi() {
    if (mpirun(1)) return true;
    MESSAGE("skipped: no mpirun here");
    return false;
}

/// A walk of some frames into files NAME01.hdr ...; of one process where `ranks` is 0.
ProgramResult walk(const TemporaryFolder& folder, const std::string& name, int ranks,
                   std::vector<std::string> words) {
    const std::string out = folder.path(name + "%02d.hdr");
    words.insert(words.end(), {"-o", out, folder.path("room.rad")});
    if (ranks == 0) return run_program(line(words));
    return run_program(line(words), "", *mpirun(ranks));
}

void check_same_frames(const TemporaryFolder& folder, const std::string& name, int frames) {
    for (int i = 1; i <= frames; ++i) {
        const std::string number = (i < 10 ? "0" : "") + std::to_string(i) + ".hdr";
        CAPTURE(number);
        CHECK(pixels_of(folder.path(name + number)) == pixels_of(folder.path("one" + number)));
    }
}

struct WalkSplit {
    int ranks = 0;
    std::vector<std::string> options;
};

}  // namespace

TEST_CASE("animate on ranks: the bytes of one process in each frame, for every split") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    (void)folder.write("room.rad", kRoom);
    const std::vector<std::string> forward{"--walk", "forward", "--frames", "10"};
    REQUIRE(walk(folder, "one", 0, {"--walk", "forward", "--frames", "10", "-n", "1"}).status == 0);
    const std::vector<WalkSplit> splits{{0, {"-n", "2"}},
                                        {0, {"-n", "7"}},
                                        {3, {"--variant", "ranks"}},
                                        {4, {"--variant", "ranks", "--projectors", "2"}},
                                        {2, {"--variant", "hybrid", "-n", "1"}},
                                        {2, {"--variant", "hybrid", "-n", "2"}}};
    for (const WalkSplit& split : splits) {
        CAPTURE(split.ranks);
        std::vector<std::string> words = split.options;
        words.insert(words.end(), forward.begin(), forward.end());
        words.insert(words.end(), {"--stats", folder.path("s.json")});
        const ProgramResult result = walk(folder, "other", split.ranks, words);
        CHECK(result.err.empty());
        REQUIRE(result.status == 0);
        check_same_frames(folder, "other", 10);
        CHECK(figure(folder.path("s.json"), "/reuse/frames") == 10);
        CHECK(figure(folder.path("s.json"), "/reuse/reused") > 0.5);
    }
}

TEST_CASE("animate on ranks: indirect light, found in rounds, is that of one process") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    (void)folder.write("room.rad", kRoom);
    const std::vector<std::string> words{
        "--walk", "turn", "--frames", "2",  "-ab", "1", "--deterministic", "-ad",  "64",
        "-x",     "32",   "-y",       "24", "-n",  "1", "--reuse",         "cloud"};
    const auto keeping = [&](const std::string& file, const std::string& variant) {
        std::vector<std::string> all = words;
        all.insert(all.end(), {"--variant", variant, "-af", folder.path(file)});
        return all;
    };
    REQUIRE(walk(folder, "one", 0, keeping("one.amb", "threads")).status == 0);
    for (const auto& [ranks, variant] : {std::pair{2, "hybrid"}, {3, "ranks"}}) {
        CAPTURE(ranks);
        std::filesystem::remove(folder.path("other.amb"));
        const ProgramResult result = walk(folder, "other", ranks, keeping("other.amb", variant));
        CHECK(result.err.empty());
        REQUIRE(result.status == 0);
        check_same_frames(folder, "other", 2);
        CHECK(read_whole(folder.path("other.amb")) == read_whole(folder.path("one.amb")));
    }
}

TEST_CASE("animate on ranks: a view that stands still is refined as by one process") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    (void)folder.write("room.rad", kRoom);
    const std::string path = folder.write("still.vf",
                                          "VIEW= -vp 0 -6 2\n"
                                          "VIEW= -vp 0 -5.9 2\n"
                                          "VIEW= -vp 0 -5.9 2\n"
                                          "VIEW= -vp 0 -5.9 2\n"
                                          "VIEW= -vp 0 -5.8 2\n");
    const std::vector<std::string> words{"--path", path, "--refine", "60", "-n", "1"};
    REQUIRE(walk(folder, "one", 0, words).status == 0);
    for (const int ranks : {2, 3}) {
        const ProgramResult result = walk(folder, "other", ranks, words);
        CHECK(result.err.empty());
        REQUIRE(result.status == 0);
        check_same_frames(folder, "other", 5);
    }
}

TEST_CASE("animate on ranks: a budget is no error") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    (void)folder.write("room.rad", kRoom);
    const ProgramResult result =
        walk(folder, "late", 3, {"--walk", "turn", "--frames", "3", "--budget", "1"});
    CHECK(result.err.empty());
    CHECK(result.status == 0);
    CHECK(std::filesystem::exists(folder.path("late03.hdr")));
}
