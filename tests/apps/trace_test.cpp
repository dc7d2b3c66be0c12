// lightwalk trace and info, from outside.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/program.h"
#include "tests/io/bsdf/bsdf_text.h"

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

/// A lamp, its image in a mirror, and a window that mirrors itself in it.
const std::string kTrees = R"(
void plastic white 0 0 5 .5 .5 .5 0 0
void mirror silver 0 0 3 .9 .9 .9
void glass clear 0 0 3 .8 .8 .8
void light lamp 0 0 3 10 20 30
white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
silver polygon looking_glass 0 0 12  5 -5 0  5 -5 5  5 5 5  5 5 0
clear polygon window 0 0 12  -3 -1 1  -3 1 1  -3 1 3  -3 -1 3
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

TEST_CASE("trace: a limited ray ends before the surface that holds its end, whatever rounds") {
    const TemporaryFolder folder;
    const std::string scene =
        folder.write("floor.rad", kFloor +
                                      "void glass pane 0 0 3 .9 .9 .9\n"
                                      "pane ring window 0 0 8 0 0 .4 0 0 1 0 9\n");
    const auto hits = [&](double excess, const std::vector<std::string>& options) {
        std::string rays;
        for (int k = 1; k <= 120; ++k) {
            const double x = k * 0.03, z = k % 2 == 0 ? 0.3 : 1 + k * 0.01;
            const double scale = 1 + excess / std::hypot(x, z);
            std::ostringstream line;
            line.precision(12);
            line << x << " 0 " << z << ' ' << -x * scale << " 0 " << -z * scale << '\n';
            rays += line.str();
        }
        std::vector<std::string> words{"trace", "-h", "-w", "-ld+", "-dt", "0", "-n", "1"};
        words.insert(words.end(), options.begin(), options.end());
        words.push_back(scene);
        const std::string out = run_program(words, rays).out;
        std::size_t found = 0;
        for (std::size_t at = out.find("floor"); at != std::string::npos;
             at = out.find("floor", at + 1))
            ++found;
        return found;
    };
    for (const double excess : {-1e-3, -1e-5, -1e-6, 0.0, 1e-9, 5e-7, 1e-6}) {
        CAPTURE(excess);
        CHECK(hits(excess, {"-os"}) == 0);
        CHECK(hits(excess, {"-ovs"}) == 0);
        CHECK(hits(excess, {"-i", "-ovs"}) == 0);
        CHECK(hits(excess, {"-oTs"}) == 0);
    }
    for (const double excess : {1.2e-6, 1e-5, 1e-3}) {
        CAPTURE(excess);
        CHECK(hits(excess, {"-os"}) == 60);    // the others meet the window first
        CHECK(hits(excess, {"-oTs"}) == 120);  // through the window
    }
}

TEST_CASE("trace: -oM names what stands behind aliases, -om the alias") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("aliases.rad", R"(
void plastic white 0 0 5 .5 .4 .3 0 0
void alias layer1 white
void alias layer2 layer1
void brightfunc half 2 .5 . 0 0
half alias layer3 layer2
void light lamp 0 0 3 1 1 1
void alias layer4 lamp
void mixfunc mix 4 white lamp .5 . 0 0
void alias layer5 mix
inherit alias layer6 layer1
void alias layer7 half
layer7 plastic plain 0 0 5 .1 .1 .1 0 0
void plastic white 0 0 5 .2 .2 .2 0 0
white sphere s0 0 0 4 0 0 0 .4
layer1 sphere s1 0 0 4 1 0 0 .4
layer2 sphere s2 0 0 4 2 0 0 .4
layer3 sphere s3 0 0 4 3 0 0 .4
layer4 sphere s4 0 0 4 4 0 0 .4
layer5 sphere s5 0 0 4 5 0 0 .4
layer6 sphere s6 0 0 4 6 0 0 .4
plain sphere s7 0 0 4 7 0 0 .4
half sphere s8 0 0 4 8 0 0 .4
)");
    std::string rays;
    for (int x = 0; x < 9; ++x) rays += std::to_string(x) + " 0 5 0 0 -1\n";
    // All of this is what Radiance's rtrace 6.1 prints.
    const std::string expected =
        "s0\twhite\twhite\t\ns1\tlayer1\twhite\t\ns2\tlayer2\twhite\t\n"
        "s3\tlayer3\twhite\t\ns4\tlayer4\tlamp\t\ns5\tlayer5\tmix\t\n"
        "s6\tlayer6\twhite\t\ns7\tplain\tplain\t\ns8\thalf\tvoid\t\n";
    CHECK(run_program({"trace", "-h", "-w", "-osmM", scene}, rays).out == expected);
    const std::string frozen = folder.path("aliases.lwz");
    REQUIRE(run_program({"freeze", "--quiet", scene, "-o", frozen}).status == 0);
    CHECK(run_program({"trace", "-h", "-w", "-osmM", frozen}, rays).out == expected);
}

TEST_CASE("trace: a line that is no ray is an error after the answers to those before it") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    const std::string rays = "1 1 3 0 0 -1\n2 1 3 0 0 -1\n";
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{}, {"-n", "1"}, {"-I", "-ovs"}, {"-oTs"}, {"-w", "-x", "1"}}) {
        std::vector<std::string> words{"trace", "-h", "-os"};
        words.insert(words.end(), options.begin(), options.end());
        words.push_back(scene);
        const ProgramResult sound = run_program(words, "\n" + rays + "\n \r\n");
        CHECK(sound.status == 0);
        const ProgramResult bad = run_program(words, rays + "sensor 3 1 3 0 0 -1\n" + rays);
        CHECK(bad.status == 1);
        CHECK(bad.out == sound.out);
        CHECK(bad.err == "standard input:3: expected six numbers for each ray, found \"sensor\"\n");
        const ProgramResult cut = run_program(words, rays + "1 2 3\n");
        CHECK(cut.status == 1);
        CHECK(cut.out == sound.out);
    }
    const ProgramResult columns =
        run_program({"trace", "-h", "-os", scene}, "1 1 3 0 0 -1 7\n2 1 3 0 0\n");
    CHECK(columns.status == 0);
    CHECK(columns.err.find("standard input:1: a ray begins within this line") != std::string::npos);
}

TEST_CASE("trace: -ot and -oT print trees of rays as rtrace does") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("trees.rad", kTrees);
    const auto traced = [&](const std::vector<std::string>& options, const std::string& rays) {
        std::vector<std::string> words{"trace", "-h-", "-dt", "0", "-dr", "1", "-ds", "0"};
        words.insert(words.end(), options.begin(), options.end());
        words.push_back(scene);
        const ProgramResult result = run_program(words, rays);
        CHECK(result.status == 0);
        CHECK(result.err.empty());
        return result.out;
    };
    // All of these are what Radiance's rtrace 6.1 prints.
    const std::string down = "1 1 3 0 0 -1", to_window = "-1 0 2 -1 0 0", sensor = "2 0 0 0 0 1";
    CHECK(traced({"-oTsLVW"}, down) ==
          "\tbulb\t4.996152e+00\t7.127781e-03\t1.425556e-02\t2.138334e-02"
          "\t7.127781e-04\t7.127781e-04\t7.127781e-04\t\n"
          "\t\tbulb\t5.546711e+00\t8.131429e-04\t1.626286e-03\t2.439429e-03"
          "\t8.131429e-05\t8.131429e-05\t8.131429e-05\t\n"
          "\tlooking_glass\t4.597369e+00\t8.131429e-04\t1.626286e-03\t2.439429e-03"
          "\t9.034921e-05\t9.034921e-05\t9.034921e-05\t\n"
          "floor\t3.000000e+00\t7.940925e-03\t1.588185e-02\t2.382277e-02"
          "\t1.000000e+00\t1.000000e+00\t1.000000e+00\t\n");
    CHECK(traced({"-otsL"}, down) == "floor\t3.000000e+00\t\n");
    CHECK(traced({"-os~tLm"}, to_window) ==
          "\t1.000000e+10\t*\t\n\t\t\t1.000000e+10\t*\t\n\t\t\t\t\t1.000000e+10\t*\t\n"
          "\t\t\t\t\t\t\t1.000000e+10\t*\t\n\t\t\t\t\t\t8.000000e+00\tclear\t\n"
          "\t\t\t\t\t8.000000e+00\tsilver\t\n\t\t\t\t8.000000e+00\tclear\t\n"
          "\t\t\t8.000000e+00\tsilver\t\n\t\t8.000000e+00\tclear\t\n\t8.000000e+00\tsilver\t\n"
          "2.000000e+00\tclear\t\nwindow\t~\t\n");
    CHECK(traced({"-oTm", "-te", "clear", "-te", "lamp"}, to_window) ==
          "\t*\t\n\t\t\t*\t\n\t\t\t\t\t*\t\n\t\t\t\t\t\t\t*\t\n\t\t\t\t\tsilver\t\n\t\t\tsilver\t\n"
          "\tsilver\t\n");
    const std::string list = folder.write("list", "silver\nnonsense");
    CHECK(traced({"-otm", "-te", "clear", "-tI", list}, to_window) ==
          "\t\t\t\t\tsilver\t\n\t\t\tsilver\t\n\tsilver\t\n");
    CHECK(traced({"-ovTs", "-I"}, sensor) ==
          "\tbulb\t\n\t\tbulb\t\n\tlooking_glass\t\n4.696930e-02\t9.393860e-02\t1.409079e-01\t\n");
    CHECK(traced({"-otL"}, "0 0 0 0 0 0").empty());
    CHECK(run_program({"trace", "-otv", scene}, down).out.find("NCOMP") == std::string::npos);
}

TEST_CASE("trace: -pXYZ says so in the header") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    const std::string out = run_program({"trace", "-pXYZ", scene}, "0 0 3 0 0 1").out;
    CHECK(out.find("NCOMP=3\nPRIMARIES= 1.0000 0.0000 0.0000 1.0000 0.0000 0.0000 0.3333 "
                   "0.3333\nFORMAT=ascii\n\n") != std::string::npos);
    CHECK(run_program({"trace", "-pY", scene}).out.find("PRIMARIES") == std::string::npos);
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
        {{"-ap", "map", scene}, "option -ap names a photon map"},
        {{"-am", "2", scene}, "option -am limits the search in photon maps"},
        {{"-pS", scene}, "option -pS weights colours by another eye"},
        {{"-pM", scene}, "option -pM weights colours by another eye"},
        {{"-cs", "9", scene}, "option -cs is about spectral rendering"},
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

TEST_CASE("info: counts, bounds, lights with virtual ones, and BSDF files") {
    const TemporaryFolder folder;
    folder.write("paper.xml", lightwalk::test::matrix_text(".1 .1 .1 .1 .1 .1 .1 .1 .1"));
    const std::string scene =
        folder.write("floor.rad", kFloor + "void BSDF paper 6 0 " + folder.path("paper.xml") +
                                      " 0 0 1 . 0 0\npaper sphere ball 0 0 4 0 0 1 1\n");
    const ProgramResult result = run_program({"info", scene});
    CHECK(result.status == 0);
    for (const std::string text :
         {"primitives     8", "polygon      2", "sphere       2", "lower        -9 -9 0",
          "upper        9 9 5.2", "1 real, 1 virtual", "bulb (sphere)", "BSDF         1",
          "  three, 0.0 MB\n    transmission front  31.4 %, matrix 3 x 3\n"}) {
        CAPTURE(text);
        CHECK(result.out.find(text) != std::string::npos);
    }
    CHECK(run_program({"info"}).status == 2);
}

TEST_CASE("info: what cannot be rendered exits with 1, after all that is known of it") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("bad.rad", kFloor + R"(!make_tree oak
!make_tree elm
)");
    const std::string problems =
        scene + ":8: command \"make_tree\" is not built in; --allow-commands runs it through the " +
        "shell (and 1 more)\n";
    const ProgramResult info = run_program({"info", scene});
    CHECK(info.status == 1);
    CHECK(info.err == problems);
    CHECK(info.out.find("primitives     6") != std::string::npos);
    for (const std::string command : {"trace", "render"}) {
        const ProgramResult result = run_program({command, scene});
        CHECK(result.status == 1);
        CHECK(result.err == problems);
        CHECK(result.out.empty());
    }
}

TEST_CASE("info and render: a scene on standard input needs no name") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("floor.rad", kFloor);
    const ProgramResult named = run_program({"info", scene});
    const ProgramResult piped = run_program({"info"}, kFloor);
    CHECK(piped.status == 0);
    const auto what = [](const std::string& text) { return text.substr(0, text.find("memory")); };
    CHECK(what(piped.out) == what(named.out));
    const std::vector<std::string> view{"render", "-vp", "0",  "0", "3",  "-vd", "0",
                                        "1",      "-.5", "-x", "8", "-y", "8"};
    std::vector<std::string> with_name = view;
    with_name.push_back(scene);
    const auto pixels = [](const std::string& text) { return text.substr(text.find("\n\n")); };
    const ProgramResult picture = run_program(view, kFloor);
    CHECK(picture.status == 0);
    CHECK(pixels(picture.out) == pixels(run_program(with_name).out));
    for (const std::string command : {"render", "info"}) {
        const ProgramResult empty = run_program({command});
        CHECK(empty.status == 2);
        CHECK(empty.err.find("no scene: none is named, and standard input holds nothing") !=
              std::string::npos);
    }
    CHECK(run_program({"trace"}, kFloor).err.find("standard input holds the rays") !=
          std::string::npos);
    CHECK(run_program({"render", "-S", "1", "-o", folder.path("a%d.hdr")}, kFloor)
              .err.find("standard input holds the views") != std::string::npos);
}

TEST_CASE("messages: junk for a scene does not reach the terminal") {
    const TemporaryFolder folder;
    const std::string header = "#?RADIANCE\noconv a.rad\nFORMAT=Radiance_octree\n\n";
    std::string junk;
    for (int i = 1; i < 300; ++i) junk += static_cast<char>(i % 255 + 1);
    const std::string zeros = std::string("\x1b[2J\0\x01 x y", 9);
    for (const std::string& bytes :
         {junk, zeros, header + junk, header + zeros, std::string("void \x1b[31m\x07 x 0 0 0")}) {
        const ProgramResult result = run_program({"info"}, bytes);
        CHECK(result.status == 1);
        CHECK(result.err.starts_with("standard input"));
        CHECK(result.err.size() < 2000);
        for (const char c : result.err) CHECK((c == '\n' || (c >= ' ' && c <= '~')));
    }
}

TEST_CASE("trace: a scene without light is a warning, where light matters") {
    const TemporaryFolder folder;
    const std::string floor = "void plastic p 0 0 5 1 1 1 0 0 p sphere s 0 0 4 0 0 0 1\n";
    const std::string dark = folder.write("dark.rad", floor);
    const std::string sky =
        folder.write("sky.rad", floor + "void glow g 0 0 4 1 1 1 0 g source sky 0 0 4 0 0 1 180\n");
    const std::string near =
        folder.write("near.rad", floor + "void glow g 0 0 4 1 1 1 2 g sphere b 0 0 4 0 0 4 1\n");
    const auto warns = [](const std::vector<std::string>& options) {
        std::vector<std::string> words{"trace", "-h"};
        words.insert(words.end(), options.begin(), options.end());
        const ProgramResult result = run_program(words, "0 0 3 0 0 -1");
        CHECK(result.status == 0);
        return result.err == "lightwalk trace: warning - no light sources found\n";
    };
    CHECK(warns({dark}));
    CHECK(warns({"-av", "1", "1", "1", dark}));
    CHECK_FALSE(warns({"-oL", dark}));
    CHECK_FALSE(warns({"-w-", dark}));
    CHECK(warns({sky}));
    CHECK_FALSE(warns({"-ab", "1", sky}));
    CHECK_FALSE(warns({near}));
}
