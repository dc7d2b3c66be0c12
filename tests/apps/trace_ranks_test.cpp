// lightwalk trace on ranks, started by mpirun.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

const std::string kScene = R"(
void plastic white 0 0 5 .5 .5 .5 .1 .1
void mirror silver 0 0 3 .9 .9 .9
void light lamp 0 0 3 10 20 30
white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
silver polygon glass 0 0 12  5 -5 0  5 -5 5  5 5 5  5 5 0
lamp sphere bulb 0 0 4 0 0 5 .2
)";

/// Rays down to the floor; every thousandth has no direction.
std::vector<float> some_rays(int count) {
    std::vector<float> numbers;
    for (int i = 0; i < count; ++i) {
        const float a = 0.37F * static_cast<float>(i);
        const float down = i % 1000 == 999 ? 0.0F : -1.0F;
        for (const float v : {4 * std::sin(a), 4 * std::cos(1.7F * a), 3.0F, down * std::sin(3 * a),
                              down * .3F, down})
            numbers.push_back(v);
    }
    return numbers;
}

std::string as_text(const std::vector<float>& numbers) {
    std::string text;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        text += std::to_string(numbers[i]) + (i % 6 == 5 ? '\n' : ' ');
    return text;
}

std::string as_bytes(const std::vector<float>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

/// Without the lines that tell the time.
std::string without_dates(const std::string& output) {
    std::string text = output;
    for (const char* name : {"CAPDATE=", "GMT="}) {
        const std::size_t begin = text.find(name);
        if (begin != std::string::npos) text.erase(begin, text.find('\n', begin) + 1 - begin);
    }
    return text;
}

/// Ranks, threads of each, how they talk.
struct Split {
    int ranks = 1;
    std::vector<std::string> options, mpi;
};
const std::vector<Split> kSplits{{3, {"--variant", "ranks"}, {}},
                                 {4, {"--variant", "ranks"}, {"--mca", "btl", "self,tcp"}},
                                 {2, {"--variant", "hybrid", "-n", "2"}, {}}};

bool have_mpi() {
    if (mpirun(1)) return true;
    MESSAGE("skipped: no mpirun here");
    return false;
}

/// Options that change nothing, so that the history line of the header is the same everywhere.
std::vector<std::string> words_of(const Split& split, const std::vector<std::string>& words) {
    std::vector<std::string> all{"trace", "-h"};
    all.insert(all.end(), split.options.begin(), split.options.end());
    all.insert(all.end(), words.begin(), words.end());
    return all;
}

}  // namespace

TEST_CASE("trace on ranks: the bytes of one process, for every split and format") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kScene);
    const std::vector<float> rays = some_rays(20000);
    const std::vector<float> few = some_rays(2100);
    struct Case {
        std::vector<std::string> options;
        std::string input;
    };
    const std::vector<Case> cases{
        {{"-ovpnL", "-dj", "1", "-ss", "1"}, as_text(rays)},
        {{"-ff", "-ov", "-ld"}, as_bytes(rays)},
        {{"-I", "-fad", "-x", "50", "-y", "42"}, as_text(few)},
        {{"-fac", "-x", "1"}, as_text(few)},
        {{"-oTvs"}, as_text(some_rays(50))},
        {{"-oL"}, ""},
    };
    for (const Case& one : cases) {
        CAPTURE(one.options.front());
        std::vector<std::string> words = one.options;
        words.push_back(scene);
        const ProgramResult alone = run_program(words_of({}, words), one.input);
        REQUIRE(alone.status == 0);
        CHECK(alone.out.empty() == one.input.empty());
        for (const Split& split : kSplits) {
            CAPTURE(split.ranks);
            const ProgramResult shared =
                run_program(words_of(split, words), one.input, *mpirun(split.ranks, split.mpi));
            CHECK(shared.status == 0);
            CHECK(shared.err == alone.err);
            CHECK(shared.out == alone.out);
        }
    }
}

TEST_CASE("trace on ranks: header lines and the sum of all ranks' rays are those of one process") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kScene);
    const std::string stats = folder.path("stats.json");
    const std::string input = as_text(some_rays(3000));
    const std::vector<std::string> words{"trace", "-n", "1", "--stats", stats, scene};
    const auto primary = [&] { return figure(stats, "/rays/primary"); };
    const ProgramResult alone = run_program(words, input);
    CHECK(alone.out.starts_with("#?RADIANCE"));
    const int rays = primary();
    CHECK(rays == 3000 - 3);
    const ProgramResult shared = run_program(words, input, *mpirun(3));
    CHECK(without_dates(shared.out) == without_dates(alone.out));
    CHECK(primary() == rays);
    CHECK(figure(stats, "/ranks") == 3);
}

TEST_CASE("trace on ranks: with indirect light every ray is answered") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kScene);
    const std::string input = as_text(some_rays(500));
    const std::vector<std::string> words{"-ab", "1", "-ad", "64", "-I", scene};
    const auto values = [](const std::string& text) {
        std::vector<double> numbers;
        const char* at = text.c_str();
        for (char* end = nullptr;; at = end) {
            const double number = std::strtod(at, &end);
            if (end == at) return numbers;
            numbers.push_back(number);
        }
    };
    const std::vector<double> alone = values(run_program(words_of({}, words), input).out);
    REQUIRE(alone.size() == 1500);
    for (const Split& split : {Split{4, {"--variant", "ranks"}, {}}, kSplits.back()}) {
        const std::vector<double> shared =
            values(run_program(words_of(split, words), input, *mpirun(split.ranks)).out);
        REQUIRE(shared.size() == alone.size());
        double difference = 0, sum = 0;
        for (std::size_t i = 0; i < alone.size(); ++i) {
            difference += std::abs(shared[i] - alone[i]);
            sum += alone[i];
        }
        CHECK(difference < 0.05 * sum);  // other values are cached, of about -aa
    }
}

TEST_CASE("trace on ranks: who waits for an answer gets it") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kScene);
    for (const Split& split : kSplits) {
        CAPTURE(split.ranks);
        RunningProgram program(words_of(split, {"-oL", "-x", "1", scene}), *mpirun(split.ranks));
        for (const char* height : {"1", "2", "3"}) {
            program.send(std::string("0 0 ") + height + " 0 0 -1\n");
            const std::string expected = std::string(height) + ".000000e+00\t\n";
            CHECK(program.receive(expected.size()) == expected);
        }
        CHECK(program.finish().status == 0);
        RunningProgram zero(words_of(split, {"-oL", scene}), *mpirun(split.ranks));
        zero.send("0 0 3 0 0 -1\n0 0 0 0 0 0\n");
        const std::string expected = "3.000000e+00\t\n1.000000e+10\t\n";
        CHECK(zero.receive(expected.size()) == expected);
        CHECK(zero.finish("0 0 2 0 0 -1\n").out == "2.000000e+00\t\n");
    }
}

TEST_CASE("trace on ranks: what cannot be read ends all of them with its message") {
    if (!have_mpi()) return;
    const TemporaryFolder folder;
    const std::string scene = folder.write("bad.rad", "paint sphere ball 0 0 4 0 0 0 1\n");
    const ProgramResult result =
        run_program({"trace", "--variant", "ranks", scene}, "0 0 0 0 0 1\n", *mpirun(3));
    CAPTURE(result.err);
    CHECK(result.status == 1);
    CHECK(result.out.empty());
    CHECK(result.err.find("bad.rad:1") != std::string::npos);
}
