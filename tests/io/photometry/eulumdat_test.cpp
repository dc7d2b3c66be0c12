#include "io/photometry/eulumdat.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/folder_scene.h"

namespace lightwalk {
namespace {

using test::FolderScene;

/// A file of 4 planes and 3 angles; `rows` are the planes that it holds, 1000 lm.
std::string eulumdat(int symmetry, const std::string& rows,
                     const std::string& body = "400\n300\n0\n0\n0\n0\n",
                     const std::string& color = "6500", const char* flux = "1000") {
    return "maker\n1\n" + std::to_string(symmetry) +
           "\n4\n90\n3\n90\nreport\nname\nnumber\nfile\ndate\n600\n600\n90\n" + body +
           "100\n80\n1,0\n0\n1\n1\nLED\n" + flux + "\n" + color +
           "\n80\n20\n0.5\n0.5\n0.5\n0.5\n0.5\n0.5\n0.5\n0.5\n0.5\n0.5\n0\n90\n180\n270\n"
           "0\n90\n180\n" +
           rows;
}

std::string ldt_error(const std::string& text) {
    try {
        (void)decode_eulumdat(text, "x.ldt");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

constexpr const char* kRoomOfLuminaire =
    "void plastic white 0 0 5 .5 .5 .5 0 0\n"
    "white polygon floor 0 0 12 -9 -9 -2 9 -9 -2 9 9 -2 -9 9 -2\n"
    "white polygon ceiling 0 0 12 -9 -9 2 -9 9 2 9 9 2 9 -9 2\n";

}  // namespace

TEST_CASE("eulumdat: a luminaire gives the light of the equal IES file, for each symmetry") {
    // The same distributions by hand: horizontal angles, and a row of intensities for each.
    struct Case {
        int symmetry;
        const char *ldt, *count, *angles, *intensities;
    };
    const std::vector<Case> cases = {
        {0, "10\n20\n30\n11\n40\n30\n12\n60\n30\n13\n80\n30\n", "5", "0 90 180 270 360",
         "10 20 30 11 40 30 12 60 30 13 80 30 10 20 30"},
        {1, "10\n20\n30\n", "1", "0", "10 20 30"},
        {2, "10\n20\n30\n11\n40\n30\n12\n60\n30\n", "5", "0 90 180 270 360",
         "10 20 30 11 40 30 12 60 30 11 40 30 10 20 30"},
        {3, "13\n80\n30\n10\n20\n30\n11\n40\n30\n", "5", "0 90 180 270 360",
         "10 20 30 11 40 30 10 20 30 13 80 30 10 20 30"},
        {4, "10\n20\n30\n11\n40\n30\n", "5", "0 90 180 270 360",
         "10 20 30 11 40 30 10 20 30 11 40 30 10 20 30"}};
    for (const Case& one : cases) {
        CAPTURE(one.symmetry);
        const test::TemporaryFolder folder;
        folder.write("x.ldt", eulumdat(one.symmetry, one.ldt, "400\n300\n100\n100\n100\n100\n"));
        folder.write("x.ies", std::string("IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 ") + one.count +
                                  " 1 2 .4 .3 .1\n1 1 20\n0 90 180\n" + one.angles + "\n" +
                                  one.intensities + "\n");
        folder.write("a.rad", std::string(kRoomOfLuminaire) + "!ldt2rad -t default x.ldt\n");
        folder.write("b.rad", std::string(kRoomOfLuminaire) + "!ies2rad -s -t default x.ies\n");
        FolderScene a(folder, {"a.rad"}), b(folder, {"b.rad"});
        for (int i = 0; i < 8; ++i) {
            const double phi = 0.3 + 0.785 * i;
            const std::array<double, 6> down{std::cos(phi), std::sin(phi), 0, 0, 0, -1};
            const std::array<double, 6> at{std::cos(phi),  std::sin(phi),  .3,
                                           -std::cos(phi), -std::sin(phi), -.3};
            CHECK(a.value(down).r > 0);
            CHECK(a.value(down).r == doctest::Approx(b.value(down).r).epsilon(1e-5));
            CHECK(a.value(at).r == doctest::Approx(b.value(at).r).epsilon(1e-5));
        }
    }
}

TEST_CASE("eulumdat: candelas are per 1000 lumens of the lamps, sizes are millimetres") {
    const EulumdatFile file = decode_eulumdat(
        eulumdat(1, "10\n20,5\n30\n", "400\n300\n0\n0\n0\n0\n", "3000K", "2500"), "x.ldt");
    CHECK(file.photometry.factor == doctest::Approx(2.5));
    CHECK(file.photometry.intensities == std::vector<double>{10, 20.5, 30});
    CHECK(file.photometry.body.x == doctest::Approx(.3));
    CHECK(file.photometry.body.y == doctest::Approx(.4));
    CHECK(file.photometry.body.z == doctest::Approx(.0005));
    const auto form = [](const char* body) {
        return decode_eulumdat(eulumdat(1, "1\n1\n1\n", body), "x.ldt").photometry.body.form;
    };
    CHECK(form("400\n0\n90\n0\n0\n0\n") == LuminousBody::Form::cylinder);
    CHECK(form("0\n0\n0\n0\n0\n0\n") == LuminousBody::Form::sphere);
}

TEST_CASE("eulumdat: lamps have the colour of a black body of their temperature") {
    // CIE 15: illuminant A (2856 K) is at .4476 .4074; the approximation holds to 1e-3.
    CHECK(black_body(2856)->x == doctest::Approx(.4476).epsilon(.003));
    CHECK(black_body(2856)->y == doctest::Approx(.4074).epsilon(.003));
    CHECK_FALSE(black_body(500));
    const auto color = [](const char* text) {
        return decode_eulumdat(eulumdat(1, "1\n1\n1\n", "400\n300\n0\n0\n0\n0\n", text), "x.ldt")
            .lamp;
    };
    REQUIRE(color("2700K"));
    CHECK(color("2700K")->color().r > color("2700K")->color().b);
    CHECK(brightness(color("4000")->color()) == doctest::Approx(1).epsilon(1e-4));
    CHECK_FALSE(color("tw"));
    CHECK_FALSE(color(""));
}

TEST_CASE("eulumdat: what is wrong is said with its line") {
    CHECK(ldt_error("") == "x.ldt:1: the file ends, expected a line of text");
    CHECK(ldt_error("maker\n1\n5\n").find("x.ldt:3: bad symmetry indicator") == 0);
    CHECK(ldt_error("maker\none\n") == "x.ldt:2: found \"one\", expected a type indicator");
    CHECK(ldt_error(eulumdat(0, "1\n2\n")) == "x.ldt:52: the file ends, expected an intensity");
    CHECK(ldt_error(eulumdat(1, "1\nx\n2\n")) == "x.ldt:51: found \"x\", expected an intensity");
    std::string odd = eulumdat(4, "1\n1\n1\n1\n1\n1\n");
    odd.replace(odd.find("\n4\n4\n"), 5, "\n4\n3\n");
    CHECK(ldt_error(odd).find("expected a multiple of 4") != std::string::npos);
}

}  // namespace lightwalk
