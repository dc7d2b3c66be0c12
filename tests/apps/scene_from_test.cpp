// --scene-from: ranks that do not see the scene's files, or see others.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

void write_scene(const TemporaryFolder& folder, const std::string& place) {
    const auto write = [&](const std::string& name, const std::string& text) {
        folder.write(place + '/' + name, text);
    };
    write("room.rad",
          "void brightfunc dirt 2 stain ./dirt.cal 0 0\n"
          "dirt plastic white 0 0 5 .5 .5 .5 0 0\n"
          "void light lamp 0 0 3 20 20 20\n"
          "!xform -t 0 0 .5 *.part\n"
          "!echo 'lamp sphere bulb 0 0 4 0 -2 4 .3' | sed s/xyz/abc/\n");
    write("dirt.cal", "stain = .5 + .5*sin(3*Px);\n");
    write("floor.part", "white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0\n");
    write("ball.part", "white sphere ball 0 0 4 0 0 1 1\n");
    write("a.vf", "VIEW= -vp 0 -6 2 -vd 0 1 -.2 -vh 45 -vv 31\n");
    write("options", "-x 60 -y 40 -ps 1\n");
}

const std::vector<std::string> kWords{"render",  "-vf", "a.vf",      "@options", "--allow-commands",
                                      "-n",      "1",   "--variant", "ranks",    "-w-",
                                      "room.rad"};

std::vector<std::string> words_with(const std::vector<std::string>& more) {
    std::vector<std::string> words = kWords;
    words.insert(words.begin() + 1, more.begin(), more.end());
    return words;
}

/// Rank 0 in one folder, two more ranks in another.
ProgramResult run_apart(const std::vector<std::string>& words, const std::string& first,
                        const std::string& others, const std::string& input = "") {
    std::vector<std::string> line = *mpirun(1, {"--wdir", first});
    line.emplace_back(LIGHTWALK_PROGRAM);
    line.insert(line.end(), words.begin(), words.end());
    for (const std::string& word :
         {std::string(":"), std::string("-n"), std::string("2"), std::string("--wdir"), others})
        line.push_back(word);
    return run_program(words, input, line);
}

std::string pixels(const std::string& picture) {
    const std::size_t begin = picture.find("\n\n");
    return begin == std::string::npos ? std::string() : picture.substr(begin);
}

bool have_mpi() {
    if (mpirun(1)) return true;
    MESSAGE("skipped: no mpirun here");
    return false;
}

}  // namespace

TEST_CASE("--scene-from rank0: ranks that see none of the files render the same bytes") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    write_scene(folder, "here");
    folder.write("there/nothing", "");
    const std::string here = folder.path("here"), there = folder.path("there");
    const ProgramResult expected = run_apart(words_with({"--scene-from", "each"}), here, here);
    CHECK(expected.status == 0);
    REQUIRE(pixels(expected.out).size() > 1000);
    const ProgramResult apart = run_apart(words_with({"--scene-from", "rank0"}), here, there);
    CHECK(apart.status == 0);
    CHECK(apart.err == expected.err);
    CHECK(pixels(apart.out) == pixels(expected.out));

    std::vector<std::string> piped = words_with({"--scene-from", "rank0"});
    piped.pop_back();  // the scene comes through standard input
    const ProgramResult by_pipe = run_apart(piped, here, there, read_whole(here + "/room.rad"));
    CHECK(by_pipe.status == 0);
    CHECK(pixels(by_pipe.out) == pixels(expected.out));

    const std::vector<std::string> trace{
        "trace", "-h",    "--scene-from",     "rank0",   "-n", "1", "--variant",
        "ranks", "@more", "--allow-commands", "room.rad"};
    folder.write("here/more", "-ov -av .1 .1 .1");
    const std::string ray = "0 0 3 0 0 -1\n";
    const ProgramResult traced = run_apart(trace, here, there, ray);
    CHECK(traced.status == 0);
    CHECK(traced.out.size() > 30);
    CHECK(traced.out == run_apart(trace, here, here, ray).out);
}

TEST_CASE("--scene-from rank0: ranks that have no frozen scene, another one, or not its sources") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    write_scene(folder, "here");
    folder.write("there/nothing", "");
    const std::string here = folder.path("here"), there = folder.path("there");
    const auto frozen = [&](const std::string& name) {
        const std::vector<std::string> words{"freeze", "--allow-commands", "-o", name, "room.rad"};
        REQUIRE(run_program(words, "", {"env", "--chdir=" + here}).status == 0);
    };
    frozen(here + "/frozen");
    std::vector<std::string> words = words_with({"--scene-from", "rank0"});
    words.back() = "frozen";
    const ProgramResult expected = run_apart(words, here, here);
    CHECK(expected.err.empty());
    CHECK(expected.status == 0);
    REQUIRE(pixels(expected.out).size() > 1000);
    const auto check_same = [&](const std::string& others) {
        const ProgramResult apart = run_apart(words, here, others);
        CHECK(apart.err.empty());
        CHECK(apart.status == 0);
        CHECK(pixels(apart.out) == pixels(expected.out));
    };
    check_same(there);  // there is none
    std::filesystem::copy_file(here + "/frozen", there + "/frozen");
    check_same(there);
    folder.write("here/more.part", "white sphere more 0 0 4 1 -2 1 .5\n");
    frozen(there + "/frozen");
    std::filesystem::remove(here + "/more.part");
    check_same(there);  // there is another one

    // With something in addition, which rank 0 reads, too.
    std::filesystem::remove(there + "/frozen");
    folder.write("here/more.rad", "white sphere more 0 0 4 1 -2 1 .5\n");
    words.push_back("more.rad");
    const ProgramResult extended = run_apart(words, here, here);
    CHECK(extended.status == 0);
    CHECK(pixels(extended.out) != pixels(expected.out));
    CHECK(pixels(run_apart(words, here, there).out) == pixels(extended.out));
}

TEST_CASE("--scene-from each: a file that differs or is missing is found and named") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    write_scene(folder, "here");
    write_scene(folder, "there");
    const std::string here = folder.path("here"), there = folder.path("there");
    folder.write("there/dirt.cal", "stain = .5 + .5*sin(4*Px);\n");
    const ProgramResult differs = run_apart(words_with({"--scene-from", "each"}), here, there);
    CHECK(differs.status == 1);
    CHECK(differs.out.empty());
    CHECK(differs.err.find("rank 1 (") != std::string::npos);
    CHECK(differs.err.find("file dirt.cal ") != std::string::npos);
    CHECK(differs.err.find("file room.rad") == std::string::npos);

    std::filesystem::remove(there + "/room.rad");
    const ProgramResult missing = run_apart(words_with({"--scene-from", "each"}), here, there);
    CHECK(missing.status == 1);
    CHECK(missing.err.find("room.rad: cannot open") != std::string::npos);
    CHECK(missing.err.find("--scene-from rank0") != std::string::npos);
}

TEST_CASE("--scene-from shared: ranks of one machine share what rank 0 has read") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    write_scene(folder, "here");
    folder.write("there/nothing", "");
    folder.write("here/bad.rad", "paint sphere ball 0 0 4 0 0 0 1\n");
    const std::string here = folder.path("here"), there = folder.path("there");
    const ProgramResult expected = run_apart(words_with({"--scene-from", "each"}), here, here);
    REQUIRE(pixels(expected.out).size() > 1000);
    const ProgramResult shared = run_apart(kWords, here, there);  // the default
    CHECK(shared.status == 0);
    CHECK(shared.err == expected.err);
    CHECK(pixels(shared.out) == pixels(expected.out));

    std::vector<std::string> words = words_with({"--scene-from", "shared"});
    words.back() = "bad.rad";
    const ProgramResult bad = run_apart(words, here, there);
    CHECK(bad.status == 1);
    CHECK(bad.out.empty());
    const std::size_t found = bad.err.find("bad.rad:1");
    CHECK(found != std::string::npos);
    CHECK(bad.err.find("bad.rad:1", found + 1) == std::string::npos);
}

TEST_CASE("--scene-from rank0: what rank 0 cannot read is said once") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    write_scene(folder, "here");
    const std::string here = folder.path("here");
    folder.write("here/room.rad", "paint sphere ball 0 0 4 0 0 0 1\n");
    const ProgramResult bad = run_apart(words_with({"--scene-from", "rank0"}), here, here);
    CHECK(bad.status == 1);
    const std::size_t found = bad.err.find("room.rad:1");
    CHECK(found != std::string::npos);
    CHECK(bad.err.find("room.rad:1", found + 1) == std::string::npos);

    const ProgramResult no_view =
        run_apart(words_with({"--scene-from", "rank0", "-vf", "none.vf"}), here, here);
    CHECK(no_view.status == 1);
    CHECK(no_view.err.find("none.vf: cannot open view file") != std::string::npos);
}

TEST_CASE("a command line that only another rank cannot understand ends the run with its message") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    write_scene(folder, "here");
    std::vector<std::string> line = *mpirun(1, {"--wdir", folder.path("here")});
    line.emplace_back(LIGHTWALK_PROGRAM);
    line.insert(line.end(), kWords.begin(), kWords.end());
    for (const std::string& word : {std::string(":"), std::string("-n"), std::string("2"),
                                    std::string("--wdir"), folder.path("here")})
        line.push_back(word);
    const ProgramResult result = run_program(words_with({"-bogus"}), "", line);
    CHECK(result.status != 0);
    CHECK(result.out.empty());
    // Ranks 1 and 2 cannot, which is said once.
    const std::size_t said = result.err.find("rank 1 (");
    CHECK(said < result.err.find("unknown option -bogus"));
    CHECK(result.err.find("unknown option -bogus") == result.err.rfind("unknown option -bogus"));
    CHECK(result.err.find("unknown option -bogus") != std::string::npos);
    CHECK(result.status == 2);
}
