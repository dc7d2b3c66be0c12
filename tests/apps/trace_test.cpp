// lightwalk trace and info, from outside.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

const std::string kFloor = R"(
void plastic white 0 0 5 .5 .5 .5 0 0
void mirror silver 0 0 3 .9 .9 .9
void light lamp 0 0 3 10 20 30
white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
silver polygon glass 0 0 12  5 -5 0  5 -5 5  5 5 5  5 5 0
lamp sphere bulb 0 0 4 0 0 5 .2
)";

}  // namespace

TEST_CASE("trace: one record a ray, in order, without header on -h") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    const ProgramResult result =
        run_program({"trace", "-h", "-os", scene}, "1 1 3 0 0 -1\n1 1 3 0 0 1  0 0 3 0 0 1\n");
    CHECK(result.status == 0);
    CHECK(result.out == "floor\t\n*\t\nbulb\t\n");
    CHECK(run_program({"trace", "-h", scene}, "0 0 3 0 0 1").out ==
          "1.000000e+01\t2.000000e+01\t3.000000e+01\t\n");
}

TEST_CASE(
    "trace: the header tells history, NCOMP and FORMAT, a resolution line follows even without "
    "header") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    const std::string out = run_program({"trace", "-oLs", "-ab", "0", scene}).out;
    CHECK(out.starts_with("#?RADIANCE\nlightwalk trace -oLs -ab 0\nSOFTWARE= Lightwalk"));
    CHECK(out.ends_with("NCOMP=2\nFORMAT=ascii\n\n"));
    const ProgramResult picture = run_program({"trace", "-h-", "-x", "2", "-y", "2", "-oL", scene},
                                              "0 0 3 0 0 -1 0 0 1 0 0 -1");
    CHECK(picture.out == "-Y        2 +X        2\n3.000000e+00\t\n1.000000e+00\t\n");
    CHECK(picture.err.find("unexpected EOF on input") != std::string::npos);
}

TEST_CASE("trace: the output does not depend on the number of threads") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    std::string rays;
    for (int i = 0; i < 700; ++i)
        rays += std::to_string(i * 0.01) + " 0 3 0 " + std::to_string(i * 0.001) + " -1\n";
    const std::vector<std::string> words{"trace", "-h", "-ovpns", "-dj", "1", "-ss", "1", scene};
    std::vector<std::string> alone = words;
    alone.insert(alone.begin() + 1, {"-n", "1"});
    std::vector<std::string> many = words;
    many.insert(many.begin() + 1, {"-n", "5", "--executor", "threads"});
    const std::string expected = run_program(alone, rays).out;
    CHECK(expected.size() > 700 * 100);
    CHECK(run_program(many, rays).out == expected);
}

TEST_CASE("trace: who waits for an answer gets it after a zero direction or a row of -x") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    {
        RunningProgram program({"trace", "-h", "-oL", scene});
        program.send("0 0 3 0 0 -1\n0 0 0 0 0 0\n");
        const std::string expected = "3.000000e+00\t\n1.000000e+10\t\n";
        CHECK(program.receive(expected.size()) == expected);
        program.send("0 0 2 0 0 -1\n");
        CHECK(program.finish().out == "2.000000e+00\t\n");
    }
    RunningProgram program({"trace", "-h", "-x", "1", "-ff", "-oL", scene});
    for (const float height : {1.0f, 2.0f}) {
        const float ray[] = {0, 0, height, 0, 0, -1};
        program.send(std::string(reinterpret_cast<const char*>(ray), sizeof ray));
        CHECK(program.receive(4) == std::string(reinterpret_cast<const char*>(&height), 4));
    }
    CHECK(program.finish().status == 0);
}

TEST_CASE("trace: -I gives the irradiance at a point, -ld limits rays, -i takes the surface seen") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    const std::string sensor =
        run_program({"trace", "-h", "-I", "-dt", "0", "-ovLs", "-dr", "0", scene}, "0 0 0 0 0 1")
            .out;
    // A sphere of radiance L and radius r at distance d above: E = pi L r^2 / d^2 (from the plane's
    // point).
    CHECK(std::stod(sensor) == doctest::Approx(3.14159265 * 10 * 0.04 / 25).epsilon(2e-3));
    CHECK(sensor.ends_with("1.000000e-05\t*\t\n"));
    const std::string seen =
        run_program({"trace", "-h", "-i", "-dt", "0", "-dr", "0", scene}, "0 0 1 0 0 -1").out;
    CHECK(std::stod(seen) == doctest::Approx(std::stod(sensor)).epsilon(1e-3));
    CHECK(run_program({"trace", "-h", "-ld", "-oLs", scene}, "0 0 3 0 0 -2").out ==
          "1.000000e+10\t*\t\n");
}

TEST_CASE("trace: misuse exits with 2, bad scenes with 1") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"-oq", scene}, "unrecognized output option 'q'"},
        {{"-o", scene}, "empty output specification"},
        {{"-fac", "-ovn", scene}, "format c"},
        {{"-I", "-oL", scene}, "require some value output"},
        {{"-"}, "standard input holds the rays"},
        {{"-tt", scene}, "unknown option -tt"},
        {{}, "no scene"},
    };
    for (const auto& [options, message] : cases) {
        std::vector<std::string> words{"trace"};
        words.insert(words.end(), options.begin(), options.end());
        const ProgramResult result = run_program(words);
        CAPTURE(message);
        CHECK(result.status == 2);
        CHECK(result.err.find(message) != std::string::npos);
        CHECK(result.out.empty());
    }
    const ProgramResult missing = run_program({"trace", folder.path("none.rad")});
    CHECK(missing.status == 1);
    CHECK(missing.err.find("none.rad") != std::string::npos);
    CHECK(missing.out.empty());
}

TEST_CASE("trace: -defaults are rtrace's") {
    const std::string out = run_program({"trace", "-defaults"}).out;
    for (const std::string text :
         {"-dt 0.030000\t", "-lr -10\t", "-u+\t", "-ds 0.200000\t", "-dr 2\t", "-ov\t", "-h+\t"}) {
        CAPTURE(text);
        CHECK(out.find(text) != std::string::npos);
    }
}

TEST_CASE("info: counts, bounds, lights with virtual ones, and what is not supported") {
    const TemporaryFolder folder;
    const std::string scene =
        folder.write("floor.rad", kFloor + "void BSDF paper 6 0 paper.xml 0 0 1 . 0 0\n");
    const ProgramResult result = run_program({"info", scene});
    CHECK(result.status == 0);
    for (const std::string text :
         {"primitives     7", "polygon      2", "sphere       1", "lower        -9 -9 0",
          "upper        9 9 5.2", "1 real, 1 virtual", "bulb (sphere)", "unsupported",
          "BSDF         1"}) {
        CAPTURE(text);
        CHECK(result.out.find(text) != std::string::npos);
    }
    CHECK(run_program({"info"}).status == 2);
}
