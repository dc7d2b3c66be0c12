#include "io/generators/generator.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/folder_scene.h"
#include "tests/io/generators/generated.h"

namespace lightwalk {
namespace {

using test::FolderScene;

constexpr const char* kRoomOfLamp =
    "void plastic white 0 0 5 .5 .5 .5 0 0\n"
    "white polygon floor 0 0 12 -9 -9 -2 9 -9 -2 9 9 -2 -9 9 -2\n"
    "white polygon ceiling 0 0 12 -9 -9 2 -9 9 2 9 9 2 9 -9 2\n";

/// Three rays at the lamp, two at the floor and one at the ceiling: origins and directions.
constexpr std::array<std::array<double, 6>, 6> kRaysAtLamp = {{{1, .5, -1.5, -1.04, -.47, 1.5},
                                                               {-1.5, 2, 1.8, 1.5, -2, -1.8},
                                                               {.13, -.07, -1.9, -.1, .05, 1.9},
                                                               {1, .5, 0, 0, 0, -1},
                                                               {-.4, -1.2, -1, 0, 0, -1},
                                                               {.7, .9, 0, 0, 0, 1}}};

/// A file of a luminaire, a command that reads it, and the red radiance along the rays. In the file
/// @H is a header, and @C, @N and @P are numbers.
struct LampCase {
    const char *name, *file, *command;
    std::array<double, 6> red;
};

std::string expanded(std::string text) {
    const std::string values = "\n100 90 80 70 60 110 95 85 75 65 120 100 90 80 70\n";
    const auto replace = [&text](const char* mark, const std::string& with) {
        if (const std::size_t at = text.find(mark); at != std::string::npos)
            text.replace(at, 2, with);
    };
    replace("@H", "IESNA:LM-63-2002\n[LAMP] HPS\n");
    replace("@C", "1 1000 2 5 3 1 2 ");
    replace("@N", "\n.9 1 60\n0 45 90 135 180\n0 45 90" + values);
    replace("@P", "\n.9 1 60\n0 45 90 135 180\n90 180 270" + values);
    return text;
}

// The radiances are those of Radiance's ies2rad and rtrace (-ds 0 -dj 0 -dt 0 -dc 1).
const std::vector<LampCase> kLampCases = {
    {"a point",
     "@HTILT=NONE\n@C0 0 0@N",
     "ies2rad -s -t default x.ies",
     {0.0140454, 998136.0, 0.0251939, 0.0259432, 0.0248818, 0.0189901}},
    {"a flat rectangle",
     "@HTILT=NONE\n@C.3 .4 0@N",
     "ies2rad -s -t default x.ies",
     {9.99109, 11.1805, 8.80857, 0.0259471, 0.024885, 0.0189932}},
    {"a box in feet",
     "@HTILT=NONE\n1 1000 2 5 3 1 1 1 1.5 .5@N",
     "ies2rad -s -t default -m 3 x.ies",
     {18.5983, 15.7543, 22.0777, 0.077326, 0.0742253, 0.0566307}},
    {"a disk",
     "@HTILT=NONE\n@C-.3 -.3 0@N",
     "ies2rad -s -t default x.ies",
     {16.9614, 18.9805, 14.9539, 0.0259472, 0.024885, 0.0189933}},
    {"an upright cylinder of 1991",
     "IESNA91\nTILT=NONE\n@C-.3 0 .2@N",
     "ies2rad -s -t default x.ies",
     {10.3057, 8.71096, 14.2425, 0.0183849, 0.0167427, 0.013457}},
    {"an ellipsoid of 1986",
     "TILT=NONE\n@C-.3 .4 .2@N",
     "ies2rad -s -t default x.ies",
     {6.17157, 5.296, 8.40315, 0.0257752, 0.0246912, 0.0188572}},
    {"a lying cylinder of 1995",
     "IESNA:LM-63-1995\nTILT=NONE\n@C.3 0 -.2@N",
     "ies2rad -s -t default x.ies",
     {28.5714, 26.5557, 0.0253234, 0.0259422, 0.024878, 0.0189887}},
    {"a sphere, in centimetres",
     "IES:LM-63-2019\nTILT=NONE\n@C-.3 -.3 -.3@N",
     "ies2rad -s -dc -t default x.ies | xform -s .01",
     {13.4985, 11.0904, 14.9281, 0.0259432, 0.0248818, 0.0189901}},
    {"an illum",
     "@HTILT=NONE\n@C.3 .4 0@N",
     "ies2rad -s -i .2 -t default x.ies",
     {0.0140454, 0.00749073, 0.0251938, 0.0259431, 0.0248817, 0.01899}},
    {"a lamp of the table",
     "@HTILT=NONE\n@C.3 .4 .2@N",
     "ies2rad -s x.ies",
     {11.3198, 9.13354, 14.8722, 0.0453892, 0.0435584, 0.0332409}},
    {"a lamp of the header before 1991",
     "metal halide lamp\nTILT=NONE\n@C.3 .4 0@N",
     "ies2rad -s -c .1 .2 .3 x.ies",
     {9.7456, 10.9057, 8.59213, 0.0253096, 0.0242736, 0.0185266}},
    {"half a circle of planes from 90 degrees",
     "@HTILT=NONE\n@C.3 .4 .2@P",
     "ies2rad -s -t default x.ies",
     {6.4497, 5.43515, 8.49141, 0.026235, 0.0236468, 0.0196305}},
    {"uneven planes of half a circle, only downward",
     "@HTILT=NONE\n1,1000,1,3,3,1,2,.3,.4,.2\n1,1,60\n0,30,90\n0,70,180\n1,2,3\n4,5,6\n7,8,9\n",
     "ies2rad -s -t default x.ies",
     {0.18505, 0.0, 0.104965, 0.000496114, 0.000867845, 0.0}},
    {"a whole circle, only upward",
     "@HTILT=NONE\n1 1000 1 2 4 1 2 .3 .4 .2\n1 1 60\n90 180\n0 90 180 270\n100 200 300 400 500 "
     "600 700 800\n",
     "ies2rad -s -t default x.ies",
     {0.0, 33.5961, 0.0, 0.0, 0.0, 0.043698}},
    {"type B",
     "@HTILT=NONE\n1 1000 1 3 3 2 2 .3 .4 0\n1 1 60\n-90 0 90\n0 45 90\n10 300 10 10 100 20 0 20 "
     "30\n",
     "ies2rad -s -t default x.ies",
     {8.3119, 0.0, 13.2365, 0.025333, 0.0192211, 0.0}},
    {"type B, not symmetric",
     "@HTILT=NONE\n1 1000 1 3 3 2 2 .3 .4 0\n1 1 60\n-90 0 90\n-90 0 90\n10 300 10 10 100 20 0 20 "
     "30\n",
     "ies2rad -s -t default x.ies",
     {5.38876, 0.0, 4.47852, 0.0144762, 0.00861473, 0.0}},
    {"a lamp that stands in the luminaire, tilted",
     "@HTILT=INCLUDE\n1\n3\n0 45 90\n1 .8 .3\n@C.3 .4 0@N",
     "ies2rad -s -t default x.ies | xform -rx 30 -ry 20",
     {10.2965, 903.334, 8.82107, 0.020392, 0.0194222, 0.018048}},
    {"a lamp that lies along the luminaire, tilted",
     "@HTILT=INCLUDE\n2\n4\n0 45 90 180\n1 .8 .3 .5\n@C.3 .4 0@N",
     "ies2rad -s -t default x.ies | xform -rx 30 -ry 20",
     {12.2274, 1072.74, 10.4753, 0.0242161, 0.0230645, 0.0214326}},
    {"a lamp that lies across the luminaire, tilted",
     "@HTILT=INCLUDE\n3\n3\n0 45 90\n1 .8 .3\n@C.3 .4 0@N",
     "ies2rad -s -t default x.ies | xform -rx 30 -ry 20",
     {7.74405, 679.401, 6.63436, 0.0153369, 0.0146075, 0.013574}},
};

}  // namespace

TEST_CASE("ies2rad: luminaires of each kind give the light that Radiance gives them") {
    for (const LampCase& lamp : kLampCases) {
        CAPTURE(lamp.name);
        const test::TemporaryFolder folder;
        folder.write("x.ies", expanded(lamp.file));
        folder.write("room.rad", std::string(kRoomOfLamp) + "!" + lamp.command + "\n");
        FolderScene scene(folder, {"room.rad"});
        for (std::size_t i = 0; i < kRaysAtLamp.size(); ++i) {
            CAPTURE(i);
            const auto red = static_cast<double>(scene.value(kRaysAtLamp[i]).r);
            CHECK(std::abs(red - lamp.red[i]) <= 2e-5 * lamp.red[i]);  // printed with 6 digits
        }
    }
}

TEST_CASE("ies2rad: type A turns about the vertical axis first") {
    // 10 cd straight on; 30 cd at azimuth 45, elevation 30 (towards x), zero at the other corners.
    const test::TemporaryFolder folder;
    folder.write("x.ies",
                 "TILT=NONE\n1 1 1 3 3 3 2 0 0 0 1 1 1\n-30 0 30\n-45 0 45\n"
                 "0 0 0\n0 10 0\n0 0 30\n");
    folder.write("room.rad", "!ies2rad -s -t default x.ies\n");
    FolderScene lamp(folder, {"room.rad"});
    const double sin30 = 0.5, cos30 = std::sqrt(0.75), half = std::sqrt(0.5);
    const auto intensity = [&](const Vec3& towards) {
        const auto L = static_cast<double>(
            lamp.value({towards.x, towards.y, towards.z, -towards.x, -towards.y, -towards.z}).r);
        return 179 * L * kPi / 4 * 1e-6;  // of a sphere with a diameter of 1 mm
    };
    CHECK(intensity({0, 0, -1}) == doctest::Approx(10).epsilon(1e-4));
    CHECK(intensity({sin30, -cos30 * half, -cos30 * half}) == doctest::Approx(30).epsilon(1e-4));
    CHECK(intensity({sin30, cos30 * half, -cos30 * half}) == doctest::Approx(0));
}

TEST_CASE("ies2rad: without -s the scene is kept as a file, which other commands find") {
    const test::TemporaryFolder folder;
    folder.write("x.ies", expanded("@HTILT=NONE\n@C.3 .4 0@N"));
    folder.write("direct.rad", "!ies2rad -s -t default x.ies | xform -t 0 0 .5\n");
    folder.write("kept.rad", "!ies2rad -t default -o lamp x.ies\n!xform -t 0 0 .5 lamp.rad\n");
    FolderScene direct(folder, {"direct.rad"}), kept(folder, {"kept.rad"});
    const std::array<double, 6> ray{.1, .1, -2, 0, 0, 1};
    CHECK(direct.value(ray).r > 0);
    CHECK(direct.value(ray) == kept.value(ray));
    CHECK_FALSE(std::filesystem::exists(folder.path("lamp.rad")));
    CHECK_FALSE(std::filesystem::exists(folder.path("lamp.dat")));
}

TEST_CASE("a luminaire may be named as a scene: each has its own data, whatever the folder") {
    const test::TemporaryFolder folder;
    const auto lamp = [](const char* candelas) {
        return std::string("TILT=NONE\n1 1 1 2 1 1 2 .3 .4 0 1 1 1\n0 90\n0\n") + candelas;
    };
    folder.write("a/lamp.ies", lamp("100 100"));
    folder.write("b/lamp.IES", lamp("300 300"));
    const std::array<double, 6> ray{.1, .1, -2, 0, 0, 1};
    FolderScene first(folder, {"a/lamp.ies"}), second(folder, {"b/lamp.IES"});
    CHECK(first.value(ray).r == doctest::Approx(100 / 179.0 / .12).epsilon(1e-5));
    CHECK(second.value(ray).r == doctest::Approx(300 / 179.0 / .12).epsilon(1e-5));
    FolderScene both(folder, {"a/lamp.ies", "b/lamp.IES"});
    CHECK(both.warnings.messages.size() == 2);  // of the colours that are not known
    folder.write("bad.ies", "TILT=NONE\n1 1 1 2 1 1 2 .3 .4 0 1 1 1\n0 ninety\n");
    CHECK_THROWS_WITH_AS(
        FolderScene(folder, {"bad.ies"}),
        (folder.path("bad.ies") + ":3: found \"ninety\", expected a vertical angle").c_str(),
        InputError);
}

TEST_CASE("ies2rad: two files of one name beside each other are told apart loudly") {
    const test::TemporaryFolder folder;
    folder.write("a/x.ies", "TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n1 1");
    folder.write("b/x.ies", "TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n2 2");
    folder.write("room.rad",
                 "!ies2rad -s -t default a/x.ies\n!ies2rad -s -t default a/x.ies\n"
                 "!ies2rad -s -t default b/x.ies\n");
    FolderScene scene(folder, {"room.rad"});
    REQUIRE(scene.warnings.messages.size() == 1);
    CHECK(scene.warnings.messages[0].find("b/x.ies: \"x.dat\" has been made before") !=
          std::string::npos);
}

TEST_CASE("ies2rad: mistakes") {
    using test::generator_error;
    const test::GeneratorInput standard{"", "TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n2 2"};
    CHECK(generator_error("ies2rad -s -t default -o y", standard) == "");
    CHECK(generator_error("ies2rad -s", standard).find("output name") != std::string::npos);
    CHECK(generator_error("ies2rad -s a b").find("single input") != std::string::npos);
    CHECK(generator_error("ies2rad -o y a b").find("single input") != std::string::npos);
    CHECK(generator_error("ies2rad -dq x.ies").find("unknown option \"-dq\"") != std::string::npos);
    CHECK(generator_error("ies2rad -dm/0 x.ies").find("unknown option") != std::string::npos);
    CHECK(generator_error("ies2rad -i 0 x.ies").find("radius") != std::string::npos);
    CHECK(generator_error("ies2rad -s no.ies").find("no.ies: cannot open") == 0);
    const test::GeneratorInput tilted{"", "TILT=no.dat\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n2 2"};
    CHECK(generator_error("ies2rad -s -t default -o y", tilted) ==
          "standard input: cannot open the file of TILT=no.dat");
}

}  // namespace lightwalk
