// The program by the names of Radiance's programs. Expected outputs are those of Radiance 6.0a.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/program.h"

using namespace lightwalk::test;

namespace {

const std::string kRoom = R"(void plastic wall 0 0 5 .5 .4 .3 0 0
void light lamp 0 0 3 10 20 30
!genbox wall room 4 5 3 -i
lamp sphere bulb 0 0 4 2 2 2.5 .1
)";
const std::string kSky = "void glow g 0 0 4 1 2 4 0\ng source sky 0 0 4 0 0 1 180\n";

/// A folder with room.rad and sky.rad, and names/ with links to the program.
struct NamedFolder {
    NamedFolder() {
        folder.write("room.rad", kRoom);
        folder.write("sky.rad", kSky);
        const ProgramResult made = run_program({"install-names", folder.path("names")});
        REQUIRE(made.err.empty());
        REQUIRE(made.status == 0);
    }
    /// A script whose commands are looked for among the names first.
    [[nodiscard]] ProgramResult run(const std::string& script,
                                    const std::string& input = "") const {
        const std::string all = "PATH=$PWD/names:/usr/bin:/bin\n" + script;
        return run_program(
            {}, input, {"env", "--chdir=" + folder.path(), "bash", "-o", "pipefail", "-c", all});
    }
    std::string out(const std::string& script, const std::string& input = "") const {
        const ProgramResult result = run(script, input);
        CHECK(result.err == "");
        CHECK(result.status == 0);
        return result.out;
    }
    TemporaryFolder folder;
};

std::vector<double> numbers(const std::string& text) {
    std::vector<double> values;
    std::istringstream words(text);
    for (double value = 0; words >> value;) values.push_back(value);
    return values;
}

/// Numbers of `found` within a relative tolerance of those of Radiance.
void check_near(const std::string& found, const std::vector<double>& expected, double tolerance) {
    const std::vector<double> values = numbers(found);
    REQUIRE(values.size() == expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(values[i] - expected[i]) <= tolerance * std::abs(expected[i]));
    }
}

}  // namespace

TEST_CASE("names: install-names makes links that can be moved with the program, and again") {
    const NamedFolder names;
    CHECK(std::filesystem::is_symlink(names.folder.path("names/rtrace")));
    CHECK(run_program({"install-names", names.folder.path("names")}).status == 0);
    CHECK(names.out("for p in rtrace rpict oconv gensky getinfo vwrays; do $p -version; done | "
                    "grep -c '^RADIANCE 6.1a Lightwalk .* (6.1.0)$'") == "6\n");
    // What is no link stays, and nothing is left behind.
    std::filesystem::remove(names.folder.path("names/oconv"));
    names.folder.write("names/oconv", "mine");
    const ProgramResult refused = run_program({"install-names", names.folder.path("names")});
    CHECK(refused.status == 1);
    CHECK(refused.err.find("oconv: is there already, and is no link") != std::string::npos);
    CHECK(read_whole(names.folder.path("names/oconv")) == "mine");
    CHECK(!std::filesystem::exists(names.folder.path("names/oconv.new")));
    CHECK(run_program({"install-names"}).status == 2);
    CHECK(run_program({"install-names", names.folder.path("room.rad")}).status == 1);
}

TEST_CASE("names: oconv makes octrees that every program takes, as files and through pipes") {
    const NamedFolder names;
    names.out("oconv room.rad > room.oct && oconv -f -i room.oct sky.rad > both.oct");
    CHECK(names.out("getinfo both.oct") ==
          "both.oct:\n\t#?RADIANCE\n\toconv room.rad\n\toconv -f -i room.oct sky.rad\n"
          "\tFORMAT=Radiance_octree\n\t\n");
    CHECK(names.out("getinfo < room.oct") ==
          "#?RADIANCE\noconv room.rad\nFORMAT=Radiance_octree\n\n");
    const std::vector<double> cube = {-0.50001, -1e-5, -1.00001, 5.00002};
    check_near(names.out("getinfo -d room.oct | cut -d: -f2"), cube, 1e-9);
    check_near(names.out("getinfo -d < both.oct"), cube, 1e-9);
    const std::string rays = "1 1 1 0 0 1\n3 4 .5 1 0 0\n";
    const std::vector<double> expected = {5.378669e-02, 1.075734e-01, 1.613601e-01, 0, 0, 0};
    for (const char* scene : {"room.oct", "'!oconv room.rad'"})
        check_near(names.out(std::string("rtrace -h -I ") + scene, rays), expected, 1e-5);
    check_near(names.out("oconv - < room.rad | getinfo -d"), cube, 1e-9);
    // A sky that is added shines.
    check_near(names.out("rtrace -h both.oct", "9 9 9 0 0 1\n"), {1, 2, 4}, 1e-6);
    // Standard input is the octree of rpict.
    CHECK(names.out("oconv room.rad | rpict -x 8 -y 8 | getinfo -d") ==
          "-Y        8 +X        8\n");
}

TEST_CASE("names: octrees keep names, aliases and instances") {
    const NamedFolder names;
    names.folder.write("a.rad",
                       "void plastic red 0 0 5 .8 .1 .1 0 0\nvoid alias paint red\n"
                       "paint ring r 0 0 8 0 0 0 0 0 1 0 1\n");
    names.folder.write("b.rad",
                       "void plastic red 0 0 5 .1 .1 .8 0 0\n"
                       "void instance i 5 a.oct -t 5 0 1 0 0\n"
                       "red ring q 0 0 8 0 0 0 0 0 1 0 1\n");
    names.out("oconv a.rad > a.oct; oconv a.rad b.rad > ab.oct; oconv b.rad > b.oct");
    const std::string rays = "0 .5 9 0 0 -1\n5 .5 9 0 0 -1\n";
    // The later one of two coincident surfaces is seen; an instance shows its own materials.
    CHECK(names.out("rtrace -w -h -osmp ab.oct", rays) ==
          "q\tred\t0.000000e+00\t5.000000e-01\t0.000000e+00\t\n"
          "r\tpaint\t5.000000e+00\t5.000000e-01\t1.000000e+00\t\n");
    check_near(names.out("rtrace -w -h -av 1 1 1 -ov a.oct", "0 .5 9 0 0 -1\n"), {.8, .1, .1},
               1e-5);
    // Around what is placed.
    check_near(names.out("getinfo -d b.oct | cut -d: -f2"),
               {-1.00001, -3.500015, -2.500015, 7.00003}, 1e-5);
}

TEST_CASE("names: oconv's boundary, warnings and mistakes are Radiance's") {
    const NamedFolder names;
    check_near(names.out("oconv -b -10 -10 -10 20 room.rad | getinfo -d"),
               {-10.00001, -10.00001, -10.00001, 20.00002}, 1e-9);
    CHECK(names.out("oconv | getinfo -d") == "0 0 0 0\n");
    const auto refused = [&](const std::string& script, const std::string& message) {
        const ProgramResult result = names.run(script);
        CAPTURE(script);
        CHECK(result.status == 1);
        CHECK(result.out.empty());
        CHECK(result.err.find(message) != std::string::npos);
    };
    refused("oconv -b 0 0 0 1 room.rad", "oconv: fatal - boundary does not encompass scene\n");
    refused("oconv -zz room.rad", "oconv: fatal - unknown option: '-zz'\n");
    refused("oconv nosuch.rad", "nosuch.rad");
    refused("oconv -i room.rad sky.rad", "room.rad");
    refused("oconv -b 1 2", "expected");
    refused("oconv -n 0 room.rad", "from 1 to 511");
    refused("echo 'foo bar baz' | oconv -", "foo");
    refused("rtrace", "no scene");
    refused("rtrace -zz room.rad", "rtrace: fatal - ");
    refused("rpict -vp 1 2 x room.rad", "rpict: fatal - ");
    refused("rcontrib room.rad", "rcontrib: fatal - ");
    refused("xform -zz", "xform");
    refused("genbox", "genbox");
    refused("genbox m b nan 1 1", "genbox");
    refused("gensky 13 1 1", "gensky");
    refused("pvalue nosuch.hdr", "nosuch.hdr");
    refused("pfilt -x 0 nosuch.hdr", "expected a size");
    refused("vwrays -vd 0 0 0", "zero view direction");
    refused("evalglare room.rad", "evalglare: fatal - ");
    refused("getinfo nosuch", "cannot open");
}

TEST_CASE("names: rtrace, rpict and rcontrib give Radiance's numbers, header and history") {
    const NamedFolder names;
    names.out("oconv room.rad > room.oct");
    const std::string ray = "1 1 1 0 0 -1\n";
    check_near(names.out("rtrace -h -ovpn room.oct", ray),
               {5.275081e-03, 8.440129e-03, 9.495146e-03, 1, 1, 0, 0, 0, 1}, 1e-5);
    CHECK(names.out("rtrace -w -ab 0 room.oct", ray)
              .starts_with("#?RADIANCE\noconv room.rad\nrtrace -w -ab 0\nSOFTWARE= "));
    check_near(
        names.out("rcontrib -h -I -ab 0 -dj 0 -m lamp room.oct", "1 1 1 0 0 1\n3 4 .5 1 0 0\n"),
        {5.378669e-03, 5.378669e-03, 5.378669e-03, 0, 0, 0}, 1e-5);
    // As rfluxmtx calls it.
    check_near(
        names.out("rcontrib -fo+ -w- -faf -h -I -ab 0 -dj 0 -y 1 -m lamp '!oconv -f -i room.oct "
                  "sky.rad' | od -An -tf4",
                  "1 1 1 0 0 1\n"),
        {5.378669e-03, 5.378669e-03, 5.378669e-03}, 1e-5);
    names.folder.write("options.opt", "-av 1 1 1\n");
    // RGBE has steps of one in 128 of the largest channel.
    check_near(names.out("rpict -vp 2 1 1 -vd 0 1 0 -x 4 -y 4 -ps 1 -pj 0 @options.opt room.oct | "
                         "pvalue -h -H -d | tail -1"),
               {.502, .4043, .3066}, 1. / 64);
    CHECK(names.out("rpict -x 4 -y 4 room.oct | getinfo")
              .starts_with("#?RADIANCE\noconv room.rad\nrpict -x 4 -y 4\nSOFTWARE= "));
    CHECK(names.out("rtrace -defaults | grep '^-n'").starts_with("-n 1"));
    CHECK(names.out("export O='-ov -h'; rtrace '$O' room.oct", ray).size() > 10);
}

TEST_CASE("names: generators write Radiance's words") {
    const NamedFolder names;
    const std::string words = " | awk '{$1 = $1; print}'";  // one blank between them
    CHECK(names.out("genbox m b 1 2 3 | sed -n 1,9p" + words) ==
          "# genbox m b 1 2 3\n\nm polygon b.1540\n0\n0\n12\n1 0 0\n1 0 3\n0 0 3\n");
    CHECK(names.out("xform -t 1 2 3 -rz 90" + words, "m polygon p 0 0 9 0 0 0 1 0 0 1 1 0\n") ==
          "# xform -t 1 2 3 -rz 90\n\nm polygon p\n0\n0\n9\n-2 1 3\n-2 2 3\n-3 2 3\n");
    CHECK(names.out("gensky -ang 45 0 -s") ==
          "# gensky -ang 45 0 -s\n# Ground ambient level: 14.8\n\nvoid brightfunc skyfunc\n"
          "2 skybr skybright.cal\n0\n"
          "7 1 9.563e+00 2.124e+01 5.707e-01 -0.000000 -0.707107 0.707107\n");
    CHECK(names.out("replmarks -s 1 -x a.rad m", "m polygon mark 0 0 9 0 0 0 2 0 0 2 1 0\n") ==
          "# replmarks -s 1 -x a.rad m\n\n!xform -n mark -s 2.000000 -rx 180.000000 -rz "
          "180.000000 -t 2.000000 0.000000 0.000000 a.rad\n");
    const std::string sky = names.out("gendaylit -ang 45 0 -W 400 100");
    CHECK(sky.find("3 3.324e+06 3.324e+06 3.324e+06\n") != std::string::npos);
    // Commands in what xform reads are run.
    names.folder.write("call.rad", "!genbox m b 1 1 1\n");
    CHECK(names.out("xform -n x call.rad | grep -c polygon") == "6\n");
    // Big outputs come in parts.
    CHECK(names.out("gensurf m s s t 's*t' 60 60 | grep -c polygon") == "7200\n");
}

TEST_CASE("names: vwrays gives the rays that rpict traces, from the top row on") {
    const NamedFolder names;
    CHECK(names.out("vwrays -d -vh 60 -vv 30 -x 100 -y 100") == "-x 100 -y 46 -ld-\n");
    CHECK(names.out("vwrays -d -va 5 -x 8 -y 8") == "-x 8 -y 8 -ld+\n");
    CHECK(names.out("vwrays -vp 1 2 3 -vd 0 1 0 -vh 90 -vv 90 -x 2 -y 2") ==
          "1.00000e+00 2.00000e+00 3.00000e+00 -4.08248e-01 8.16497e-01 4.08248e-01\n"
          "1.00000e+00 2.00000e+00 3.00000e+00 4.08248e-01 8.16497e-01 4.08248e-01\n"
          "1.00000e+00 2.00000e+00 3.00000e+00 -4.08248e-01 8.16497e-01 -4.08248e-01\n"
          "1.00000e+00 2.00000e+00 3.00000e+00 4.08248e-01 8.16497e-01 -4.08248e-01\n");
    CHECK(names.out("vwrays -i -vh 90 -vv 90 -x 2 -y 2", "0 1\n") ==
          "0.00000e+00 0.00000e+00 0.00000e+00 -4.08248e-01 8.16497e-01 4.08248e-01\n");
    CHECK(names.out("vwrays -ff -c 3 -x 4 -y 4 | wc -c") == "1152\n");
    // The way in which a picture is traced by rtrace, and its view taken again.
    names.out(
        "oconv room.rad > room.oct; rpict -vp 2 1 1 -x 5 -y 4 -ps 1 -pj 0 -av 1 1 1 room.oct "
        "> a.hdr; vwrays -ff a.hdr | rtrace $(vwrays -d a.hdr) -ffc -av 1 1 1 room.oct > "
        "b.hdr");
    CHECK(names.out("pvalue -h -H a.hdr") == names.out("pvalue -h -H b.hdr"));
    CHECK(names.out("pvalue -h -H a.hdr | wc -l") == "16\n");
    // Positions without a ray, beyond the rim of a fisheye.
    CHECK(names.out("vwrays -vth -vh 180 -vv 180 -va 2 -vp 1 1 1 -x 4 -y 4 | sed -n 1p") ==
          "0.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00 0.00000e+00\n");
}

TEST_CASE("names: getinfo adds, replaces and removes headers") {
    const NamedFolder names;
    const std::string file = "#?RADIANCE\nA= 1\nFORMAT=ascii\n\n1 2\n";
    CHECK(names.out("getinfo -a 'B= 2' 'C= 3'", file) ==
          "#?RADIANCE\nA= 1\nB= 2\nC= 3\nFORMAT=ascii\n\n1 2\n");
    CHECK(names.out("getinfo -r 'A= 2'", file) == "#?RADIANCE\nA= 2\nFORMAT=ascii\n\n1 2\n");
    CHECK(names.out("getinfo -", file) == "1 2\n");
    CHECK(names.run("getinfo -", "no header").status == 1);
    CHECK(names.run("getinfo -c cat", file).status == 1);
}

TEST_CASE("names: pvalue writes pixels as Radiance does, and reads them") {
    const NamedFolder names;
    const std::string made = names.out("pvalue -r -h -H -d -y 1 +x 2", ".5 .25 .1\n1 2 3\n");
    CHECK(made == std::string("#?RADIANCE\npvalue -r -h -H -d -y 1 +x 2\nFORMAT=32-bit_rle_rgbe\n\n"
                              "-Y        1 +X        2\n\x80\x40\x19\x80\x40\x80\xc0\x82"));
    CHECK(names.out("pvalue -h -H", made) ==
          "      0       0       5.020e-01       2.520e-01       9.961e-02\n"
          "      1       0       1.008e+00       2.008e+00       3.008e+00\n");
    CHECK(names.out("pvalue -h -H -d -b", made).starts_with("      3.084e-01\n"));
    CHECK(names.out("pvalue -d -e +1", made)
              .ends_with("pvalue -d -e +1\nEXPOSURE=2.0000e+00\nNCOMP=3\nFORMAT=ascii\n\n-Y        "
                         "1 +X        2\n"
                         "      1.004e+00       5.039e-01       1.992e-01\n"
                         "      2.016e+00       4.016e+00       6.016e+00\n"));
    CHECK(names.out("pvalue -h -H -df | wc -c", made) == "24\n");
    CHECK(names.out("pvalue -h -H -df | pvalue -r -h -H -df -y 1 +x 2 | tail -c 8", made) ==
          "\x80\x40\x19\x80\x40\x80\xc0\x82");
    CHECK(names.out(
              "pvalue -o -h -H -d | head -1",
              "#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80") ==
          "      2.510e-01       2.510e-01       2.510e-01\n");
    CHECK(names.run("pvalue -r -h -H -d -y 9 +x 9", "1 2 3").status == 1);
    CHECK(names.run("pvalue -r -h -H -d -y 1 +x 1", "1 2 x").status == 1);
    CHECK(names.run("pvalue -zz").status == 1);
}

TEST_CASE("names: pfilt's box and Gaussian have Radiance's weights, its exposure the same mean") {
    const NamedFolder names;
    // A bright column in the middle of black ones.
    std::string text;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) text += x == 33 ? "1 1 1\n" : "0 0 0\n";
    names.folder.write("v.txt", text);
    names.out("pvalue -r -h -H -d -y 64 +x 64 v.txt > a.hdr");
    // Radiance 6.0a: -r .6 -x /4 -y /4 of such a column: .0290 .2261 .0072 around column 8.
    const std::string gaussian =
        names.out("pfilt -1 -r .6 -x /4 -y /4 a.hdr | pvalue -h -H -d -b | sed -n '136,138p'");
    check_near(gaussian, {.02899, .22607, .00716}, .04);  // Radiance's are those of a table
    check_near(names.out("pfilt -1 -x /2 -y /2 a.hdr | pvalue -h -H -d -b | sed -n '529p'"), {.502},
               1. / 64);
    CHECK(names.out("pfilt -x /2 -y /2 a.hdr | getinfo | grep EXPOSURE") ==
          "EXPOSURE=4.9805e-01\n");
    CHECK(names.out("pfilt -1 -e 2 -e +1 -x 32 -y 16 a.hdr | getinfo | tail -4") ==
          "pfilt -1 -e 2 -e +1 -x 32 -y 16\nPIXASPECT=2.000000\nEXPOSURE=4.0000e+00\n\n");
    CHECK(names.out("pfilt -1 -x 32 -y 16 -p 1 a.hdr | getinfo -d") == "-Y       16 +X       16\n");
    CHECK(names.run("pfilt -m .1 a.hdr").status == 1);
}

TEST_CASE("names: falsecolor shows values as colours, lines and a legend") {
    const NamedFolder names;
    // Luminances of 0 to 1000 cd/m2, from the left to the right.
    std::string text;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 64; ++x) {
            const std::string value = std::to_string((x + .5) / 64 * 1000 / 179);
            text += value + ' ' + value + ' ' + value + '\n';
        }
    names.folder.write("v.txt", text);
    names.out("pvalue -r -h -H -d -y 16 +x 64 v.txt > a.hdr");
    const auto row = [&](const std::string& options) {
        return numbers(
            names.out("falsecolor -i a.hdr " + options + " | pvalue -h -H -d | sed -n 1,64p"));
    };
    // The mapping that falsecolor(1) has for -spec: blue, green, red.
    const std::vector<double> spectrum = row("-lh 0 -pal spec");
    CHECK(spectrum[2] > .9);
    CHECK(spectrum[3 * 24 + 1] == doctest::Approx(1 - 1.6 * (24.5 / 64 - .375)).epsilon(.02));
    CHECK(spectrum[3 * 63] > .95);
    CHECK(spectrum[3 * 63 + 2] < .004);
    // Half of the range, of ten decades: three tenths of the scale to its end.
    const std::vector<double> decades = row("-lh 0 -pal hot -log 1");
    CHECK(decades[3 * 31] == doctest::Approx(1).epsilon(.01));  // red is full at a third
    CHECK(decades[3 * 31 + 1] == doctest::Approx(1).epsilon(.01));
    CHECK(decades[3 * 31 + 2] == doctest::Approx(3 * (1 + std::log10(31.5 / 64)) - 2).epsilon(.03));
    // Four steps have three lines between them, on the picture itself.
    const std::vector<double> lines = row("-lh 0 -cl -n 4 -pal spec");
    int drawn = 0;
    for (std::size_t x = 0; x < 64; ++x) drawn += lines[3 * x] != lines[3 * x + 1] ? 1 : 0;
    CHECK(drawn == 3);
    CHECK(row("-lh 0 -s auto") != row("-lh 0"));
    // The legend is to the left, the label its first line.
    CHECK(names.out("falsecolor -i a.hdr > b.hdr && getinfo -d < b.hdr") ==
          "-Y       16 +X      164\n");
    const std::vector<double> legend = row("-l I -lw 64");
    CHECK(legend[3 * 2] > .99);  // a serif
    CHECK(legend[3 * 10] < .004);
    CHECK(names.out("falsecolor -e -lw 0 < a.hdr | pvalue -h -H -d -b") !=
          names.out("falsecolor -lw 0 < a.hdr | pvalue -h -H -d -b"));
    CHECK(names.out("falsecolor -i a.hdr -lw 0 > b.hdr && getinfo < b.hdr | grep falsecolor") ==
          "falsecolor -i a.hdr -lw 0\n");
    for (const std::string wrong : {"-i none.hdr", "-s 0 -i a.hdr", "-r v -i a.hdr", "a.hdr",
                                    "-n 0 -i a.hdr", "-i v.txt", "-lw 9999999 -i a.hdr"}) {
        CAPTURE(wrong);
        const ProgramResult refused = names.run("falsecolor " + wrong);
        CHECK(refused.status == 1);
        CHECK(refused.out.empty());
        CHECK(refused.err.find("falsecolor: fatal - ") == 0);
    }
}

TEST_CASE("names: evalglare finds Radiance's glare in a fisheye of three discs") {
    // Luminances of 179, 10740 and 17900 cd/m2: discs at 51.6 and 28.7 degrees.
    const NamedFolder names;
    const int size = 400;
    std::string pixels;
    for (int y = size; y-- > 0;) {
        for (int x = 0; x < size; ++x) {
            const double h = (x + .5) / size - .5, v = (y + .5) / size - .5;
            const auto within = [&](double theta, double angle, double radius) {
                const double k =
                    3.14159265358979 * std::hypot(h - theta / 3.14159265358979 * std::cos(angle),
                                                  v - theta / 3.14159265358979 * std::sin(angle));
                return k < radius;
            };
            const double L = within(.9, 4, .2)                                        ? 60
                             : within(.5, 1, .1)                                      ? 100
                             : 3.14159265358979 * std::hypot(h, v) <= 1.5707963267949 ? 1
                                                                                      : 0;
            pixels += std::to_string(L) + '\n';
        }
    }
    names.folder.write("disc.txt", pixels);
    names.out(
        "pvalue -r -h -H -d -b -y 400 +x 400 disc.txt | getinfo -a 'VIEW= -vta -vh 180 -vv 180' "
        "> disc.hdr");
    const std::string line = names.out("evalglare disc.hdr 2>/dev/null");
    REQUIRE(line.starts_with("dgp,dgi,ugr,vcp,cgi,Lveil: "));
    // Radiance's DGP is .001 less than that of the formula that it names.
    check_near(line.substr(line.find(": ") + 2),
               {.315927 + .001, 23.502447, 29.468834, 3.240338, 32.936672, 153.715134}, .003);
    check_near(names.out("evalglare -V disc.hdr"), {1742.933}, .002);
    CHECK(names.run("evalglare -t 100 100 1 disc.hdr").status == 1);
    CHECK(names.run("evalglare -vtv disc.hdr").status == 1);
}
