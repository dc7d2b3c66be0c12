#include "io/photometry/ies_file.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/error.h"

namespace lightwalk {
namespace {

/// A small file with `numbers` after TILT=NONE on its line 3.
std::string with_numbers(const std::string& numbers) {
    return "IESNA:LM-63-2002\n[LAMP] a lamp\nTILT=NONE\n" + numbers;
}

/// Its numbers: three vertical angles in one plane.
constexpr const char* kNumbers = "1 1000 2 3 1 1 2 .3 .4 0\n.9 1 60\n0 45 90\n0\n10 20 30\n";

std::string refusal(const std::string& text) {
    try {
        (void)decode_ies(text, "x.ies");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// "FORM x y z", or "" for sizes that mean nothing.
std::string body_text(IesEdition edition, double width, double length, double height) {
    const auto body = luminous_body(edition, width, length, height);
    if (!body) return "";
    const auto digits = [](double v) {
        std::string text = std::to_string(v);
        return " " + text.substr(0, text.find_last_not_of('0') + 1);
    };
    const std::string form = body->form == LuminousBody::Form::box        ? "box"
                             : body->form == LuminousBody::Form::cylinder ? "cylinder"
                                                                          : "sphere";
    return form + digits(body->x) + digits(body->y) + digits(body->z);
}

}  // namespace

TEST_CASE("ies: numbers may be divided by blanks, commas and line ends as one likes") {
    const IesFile file = decode_ies(with_numbers(kNumbers), "x.ies");
    CHECK(file.photometry.vertical == std::vector<double>{0, 45, 90});
    CHECK(file.photometry.horizontal == std::vector<double>{0});
    CHECK(file.photometry.intensities == std::vector<double>{10, 20, 30});
    CHECK(file.photometry.factor == doctest::Approx(1.8));
    CHECK(file.watts == 60);
    for (const char* other :
         {"1,1000,2,3,1,1,2,.3,.4,0\r\n.9,1,60\r\n0,45,90\r\n0\r\n10,20,30",
          "1\n1000\n2\n3\n1\n1 2 .3 , .4\t0 .9 1 60 0 45 90 0 1e1 +2.0E1 30. and more\n"}) {
        CHECK(decode_ies(with_numbers(other), "x.ies").photometry.intensities ==
              file.photometry.intensities);
    }
}

TEST_CASE("ies: since 1991 keywords name the lamp, before all lines may") {
    const std::string rest =
        std::string("[TEST] b\n [LAMPCAT] c\n[MORE] d\nTILT=NONE\n") + kNumbers;
    for (const char* label : {"IESNA91", "IESNA:LM-63-1995", "IESNA:LM-63-2002", "IES:LM-63-2019"})
        CHECK(decode_ies(label + ("\r\n[LAMP] a\n" + rest), "x.ies").lamps ==
              std::vector<std::string>{" a", " c"});
    CHECK(decode_ies("a\n" + rest, "x.ies").lamps ==
          std::vector<std::string>{"a", "[TEST] b", " [LAMPCAT] c", "[MORE] d"});
}

TEST_CASE("ies: the factors of a tilted lamp stand in the file, or in another") {
    const std::string factors = "2\n3\n0 45 90\n1 .8 .3\n";
    const IesFile file = decode_ies("TILT=INCLUDE\n" + factors + kNumbers, "x.ies");
    REQUIRE(file.tilt);
    CHECK(file.tilt->geometry == 2);
    CHECK(file.tilt->angles == std::vector<double>{0, 45, 90});
    CHECK(file.tilt->factors == std::vector<double>{1, .8, .3});
    CHECK(file.photometry.intensities.size() == 3);
    const IesFile other = decode_ies(std::string("TILT=t.dat \n") + kNumbers, "x.ies");
    CHECK(other.tilt_file == "t.dat");
    CHECK_FALSE(other.tilt);
    CHECK(decode_tilt(factors, "t.dat").factors == file.tilt->factors);
}

TEST_CASE("ies: width, length and height mean a body, by the rules of the edition") {
    using Edition = IesEdition;
    for (const Edition edition : {Edition::until_1991, Edition::of_1995, Edition::since_2002}) {
        CHECK(body_text(edition, 0, 0, 0) == "sphere 0.001 0.001 0.001");
        CHECK(body_text(edition, .3, .4, 0) == "box 0.4 0.3 0.0005");
        CHECK(body_text(edition, .3, .4, .2) == "box 0.4 0.3 0.2");
        CHECK(body_text(edition, 0, .4, .2) == "box 0.4 0.001 0.2");
        CHECK(body_text(edition, -.3, 0, 0) == "cylinder 0.3 0.3 0.0005");
        CHECK(body_text(edition, .3, 0, 0) == "");
        CHECK(body_text(edition, 0, 0, .2) == "");
        CHECK(body_text(edition, .3, .4, -.2) == "");
    }
    CHECK(body_text(Edition::until_1991, -.3, 0, .2) == "cylinder 0.3 0.3 0.2");
    CHECK(body_text(Edition::until_1991, -.3, .4, 0) == "cylinder 0.3 0.3 0.0005");
    CHECK(body_text(Edition::until_1991, -.3, .4, .2) == "box 0.3 0.4 0.2");
    CHECK(body_text(Edition::until_1991, -.3, .4, -.2) == "");
    CHECK(body_text(Edition::of_1995, -.3, .4, .2) == "cylinder 0.3 0.3 0.2");
    CHECK(body_text(Edition::of_1995, .3, -.4, .2) == "cylinder 0.3 0.3 0.2");
    CHECK(body_text(Edition::of_1995, .3, 0, -.2) == "box 0.001 0.3 0.2");
    CHECK(body_text(Edition::of_1995, -.3, .4, -.2) == "box 0.4 0.3 0.2");
    CHECK(body_text(Edition::of_1995, -.3, -.3, 0) == "");
    CHECK(body_text(Edition::since_2002, -.3, -.3, 0) == "cylinder 0.3 0.3 0.0005");
    CHECK(body_text(Edition::since_2002, -.3, -.4, .2) == "cylinder 0.4 0.4 0.2");
    CHECK(body_text(Edition::since_2002, -.3, -.3, -.3) == "sphere 0.3 0.3 0.3");
    CHECK(body_text(Edition::since_2002, -.3, -.4, -.3) == "box 0.4 0.3 0.3");
    CHECK(body_text(Edition::since_2002, 0, -.4, -.3) == "box 0.4 0.001 0.3");
    CHECK(body_text(Edition::since_2002, -.3, 0, .2) == "");
}

TEST_CASE("ies: what is wrong is said with its line") {
    const auto numbers = [](const char* text) { return refusal(with_numbers(text)); };
    CHECK(refusal("hello\n") ==
          "x.ies: not a photometric file of the IES: no line begins with TILT=");
    CHECK(refusal("") == refusal("hello\n"));
    CHECK(refusal("a\nTILT=\n1").find("x.ies:2: TILT= without") == 0);
    CHECK(numbers("1 1000 1 3 1 1 2 .3 .4 0\n.9 1 60\n0 45 90\n0\n10 twenty 30\n") ==
          "x.ies:8: found \"twenty\", expected an intensity");
    CHECK(numbers("1 1000 1 3 1 1 2 .3 .4 0\n.9 1 60\n0 45 90\n0\n10 20\n") ==
          "x.ies:9: the file ends, expected an intensity");
    CHECK(numbers("1 1000 1 3 1 1 2 .3 .4 0\n.9 1 60\n0 45 45\n0\n10 20 30\n") ==
          "x.ies:6: found a vertical angle that is not larger than the one before");
    CHECK(numbers("1 1000 1 1 1 1 2 .3 .4 0\n").find("x.ies:4: bad number of vertical angles") ==
          0);
    CHECK(numbers("1 1000 1 3 99999999999 1 2 .3 .4 0\n")
              .find("x.ies:4: bad number of horizontal angles") == 0);
    CHECK(numbers("1 1000 1 20 20 1 2 .3 .4 0\n.9 1 60\n0 45 90\n0\n10 20 30\n10 20 30")
              .find("x.ies:5: the file is too short for 20 by 20") == 0);
    CHECK(numbers("1 1000 1 3 1 4 2 .3 .4 0\n").find("x.ies:4: bad photometric type") == 0);
    CHECK(numbers("1 1000 1 3 1 1 3 .3 .4 0\n").find("x.ies:4: bad units") == 0);
    CHECK(numbers("1 1000 -1 3 1 1 3 .3 .4 0\n").find("x.ies:4: found a negative number") == 0);
    CHECK(numbers("1 1000 1 3 1 1 2 .3 -.4 0\n") ==
          "x.ies:4: width, length and height mean no luminous opening: they are positive negative "
          "zero");
    CHECK(refusal("TILT=INCLUDE\n4\n").find("x.ies:2: bad geometry of the lamp") == 0);
}

}  // namespace lightwalk
