// lightwalk trace --interval, from outside.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/math/replication_seed.h"
#include "core/math/student_t.h"
#include "tests/apps/program.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(
void plastic white 0 0 5 .6 .5 .4 0 0
void light lamp 0 0 3 10 20 30
white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
white polygon wall 0 0 12  -9 4 0  9 4 0  9 4 5  -9 4 5
lamp polygon panel 0 0 12  -1 -1 3  -1 1 3  1 1 3  1 -1 3
)";

/// @param z  of the directions: -1 to the floor, 1 for sensors that see the lamp
std::string many_rays(int count, int z = -1) {
    std::string rays;
    for (int i = 0; i < count; ++i)
        rays += std::to_string(.03 * i - 2) + " 0 2.5 0 " + std::to_string(.01 * i - .3) + ' ' +
                std::to_string(z) + '\n';
    return rays;
}

ProgramResult trace(const std::vector<std::string>& options, const std::string& scene,
                    const std::string& rays = "") {
    std::vector<std::string> words{"trace", "-dj", "1", "-ds", ".4"};
    words.insert(words.end(), options.begin(), options.end());
    words.push_back(scene);
    return run_program(words, rays);
}

std::vector<double> doubles_of(const std::string& bytes) {
    std::vector<double> values(bytes.size() / sizeof(double));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
    return values;
}

template <class Container>
std::vector<std::string> words_of(std::vector<std::string> first, const Container& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
}

}  // namespace

TEST_CASE("trace --interval: the mean and interval of what runs with the seeds answer") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::vector<std::string>> kinds{
        {"-ab", "0"},
        {"-ab", "0", "-I"},
        {"-ab", "0", "-i", "-pY"},
        {"-ab", "1", "-aa", "0", "-ad", "16"},
        {"-ab", "2", "-aa", ".2", "-ad", "16", "-as", "0", "-n", "1"}};
    for (const std::vector<std::string>& kind : kinds)
        for (const int count : {2, 5}) {
            CAPTURE(kind.size());
            const std::string rays = many_rays(20, kind.back() == "-I" ? 1 : -1);
            CAPTURE(count);
            std::vector<std::vector<double>> answers;
            for (int k = 0; k < count; ++k) {
                const std::string seed = std::to_string(replication_seed(7, k));
                const ProgramResult one =
                    trace(words_of({"-h", "-fad", "--seed", seed}, kind), scene, rays);
                REQUIRE(one.status == 0);
                answers.push_back(doubles_of(one.out));
            }
            const ProgramResult all = trace(
                words_of({"-h", "-fad", "--seed", "7", "--interval", std::to_string(count)}, kind),
                scene, rays);
            REQUIRE(all.status == 0);
            const std::size_t colors = answers.front().size() / 20;
            std::vector<double> expected;
            for (std::size_t ray = 0; ray < 20; ++ray) {
                std::vector<double> halves;
                for (std::size_t c = 0; c < colors; ++c) {
                    std::vector<double> values;
                    for (const auto& answer : answers) values.push_back(answer[ray * colors + c]);
                    const MeanInterval interval = mean_interval(values);
                    expected.push_back(interval.mean);
                    halves.push_back(interval.half_width);
                }
                expected.insert(expected.end(), halves.begin(), halves.end());
            }
            CHECK(doubles_of(all.out) == expected);
            double widths = 0;  // the answers do differ
            for (std::size_t c = 0; c < colors; ++c) widths += expected[colors + c];
            CHECK(widths > 0);
        }
}

TEST_CASE("trace --interval: half-widths stand behind their colour, other fields as ever") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string up = "0 0 2 0 0 1\n", down = "0 0 2 0 0 -1\n";
    CHECK(trace({"-h", "--interval", "3"}, scene, up).out ==
          "1.000000e+01\t2.000000e+01\t3.000000e+01\t0.000000e+00\t0.000000e+00\t0.000000e+00\t\n");
    CHECK(trace({"-h", "--interval", "2", "-pA", "-osLvm"}, scene, up + up).out ==
          "panel\t1.000000e+00\t2.000000e+01\t0.000000e+00\tlamp\t\n"
          "panel\t1.000000e+00\t2.000000e+01\t0.000000e+00\tlamp\t\n");
    const std::string fields = trace({"-h", "--interval", "2", "-orpx"}, scene, down).out;
    CHECK(
        fields.starts_with("0.000000e+00\t0.000000e+00\t0.000000e+00\t0.000000e+00\t0.000000e+00"
                           "\t0.000000e+00\t0.000000e+00\t0.000000e+00\t0.000000e+00\t"));
    CHECK(trace({"--interval", "2", "-ovLs"}, scene).out.ends_with("NCOMP=8\nFORMAT=ascii\n\n"));
    CHECK(trace({"--interval", "2", "-pY", "-ff"}, scene).out.find("NCOMP=2\n") !=
          std::string::npos);
    CHECK(trace({"-h", "--interval", "2", "-faf"}, scene, down).out.size() == 6 * sizeof(float));
    CHECK(trace({"-h", "--interval", "2", "-fad"}, scene, down).out.size() == 6 * sizeof(double));
}

TEST_CASE("trace --interval: the output does not depend on threads, nor on how rays come") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::string rays = many_rays(200);
    const std::vector<std::string> options{"-h", "--interval", "4", "-ovs"};
    const std::string expected = trace(words_of(options, std::vector{"-n", "1"}), scene, rays).out;
    CHECK(expected.size() > 200 * 70);
    CHECK(trace(words_of(options, std::vector{"-n", "5", "--executor", "threads"}), scene, rays)
              .out == expected);
    RunningProgram program(
        {"trace", "-dj", "1", "-ds", ".4", "-h", "--interval", "4", "-ovs", "-x", "1", scene});
    std::string answers;
    for (std::size_t at = 0, line = 0; line < 3; ++line) {
        const std::size_t end = rays.find('\n', at) + 1;
        program.send(rays.substr(at, end - at));
        at = end;
        const std::size_t answer = expected.find('\n', answers.size()) + 1 - answers.size();
        answers += program.receive(answer);
    }
    CHECK(answers == expected.substr(0, answers.size()));
    CHECK(program.finish().status == 0);
}

TEST_CASE("trace --interval: what has no interval is refused") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("room.rad", kRoom);
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"--interval", "1"}, "2 to 100 answers"},
        {{"--interval", "101"}, "2 to 100 answers"},
        {{"--interval", "2", "-oTv"}, "trees of rays"},
        {{"--interval", "2", "-oL"}, "expected some value output"},
        {{"--interval", "2", "-ovl"}, "output field 'l' has no interval"},
        {{"--interval", "2", "-ovW"}, "output field 'W' has no interval"},
        {{"--interval", "2", "-ovq"}, "unrecognized output option 'q'"},
        {{"--interval", "2", "-o"}, "empty output specification"},
        {{"--interval", "2", "-fac"}, "format c"},
        {{"--interval", "2", "--serve"}, "--serve traces nothing"},
        {{"--interval", "2", "--timeline", folder.path("t.json")}, "is for one process"},
        {{"--interval", "2", "-af", folder.path("a.amb")}, "ambient file (-af)"},
    };
    for (const auto& [options, message] : cases) {
        const ProgramResult result = trace(options, scene);
        CAPTURE(message);
        CAPTURE(result.err);
        CHECK(result.status == 2);
        CHECK(result.err.find(message) != std::string::npos);
        CHECK(result.out.empty());
    }
}
