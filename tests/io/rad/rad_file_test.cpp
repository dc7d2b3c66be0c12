// Files of rad(1): lines, names and words. What is accepted was asked of rad of Radiance 6.1.
#include "io/rad/rad_file.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace lightwalk {
namespace {

std::string refusal_of_rad_file(const std::string& text) {
    try {
        (void)decode_rad_file(text, "s.rif");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST_CASE(
    "a rad file assigns a variable a line: comments, continued lines, an equals sign or none") {
    const RadFile file = decode_rad_file(
        "# a house\n\n  scene = a.rad b.rad # c.rad\r\nscene= \\\n  d.rad\nQUALITY M\nZONE=\n"
        "view= v -vp 1 2 3 \\\r\n -vd 0 1 0",
        "s.rif");
    REQUIRE(file.values("scene").size() == 2);
    CHECK(file.values("scene")[0].text == "a.rad b.rad");
    CHECK(file.values("scene")[0].where.line == 3);
    CHECK(file.values("scene")[1].text == "d.rad");
    CHECK(file.values("scene")[1].where.line == 4);
    REQUIRE(file.value("QUALITY") != nullptr);
    CHECK(file.value("QUALITY")->text == "M");
    CHECK(file.value("ZONE") == nullptr);  // an empty value says nothing
    REQUIRE(file.value("view") != nullptr);
    CHECK(words_of(*file.value("view")) ==
          std::vector<std::string>{"v", "-vp", "1", "2", "3", "-vd", "0", "1", "0"});
    CHECK(file.value("view")->where.line == 8);
}

TEST_CASE("names of variables may be cut short, down to two or three letters") {
    for (const char* name : {"sce", "mat", "ill", "obj", "oco", "mki", "pf",  "rpi", "rvu", "ren",
                             "vi",  "AMB", "DET", "EXP", "EYE", "IND", "OCT", "OP",  "PEN", "PI",
                             "QUA", "RA",  "REP", "RES", "UP",  "VAR", "ZF",  "ZO"})
        CHECK(refusal_of_rad_file(std::string(name) + "= 1\n") == "no error");
    for (const char* name : {"sc", "v", "Q", "QU", "zone", "Scene", "sceneX", "rview", "Z", "RE"})
        CHECK(refusal_of_rad_file(std::string(name) + "= 1\n").starts_with("s.rif:1: unknown"));
}

TEST_CASE("an unknown variable is told with its line, and the nearest one") {
    CHECK(refusal_of_rad_file("scene= a\n\nQUALTIY= M\n") ==
          "s.rif:3: unknown variable \"QUALTIY\", did you mean QUALITY?");
    CHECK(refusal_of_rad_file("void plastic a 0 0 0\n")
              .starts_with("s.rif:1: unknown variable \"void\": expected one of rad(1)"));
    CHECK(refusal_of_rad_file("= 3\n").starts_with("s.rif:1: unknown variable \"\""));
}

TEST_CASE("a variable that has one value takes the last, with a warning") {
    RadFile file = decode_rad_file("QUALITY= M\nview= X\nQUALITY= H\nview= Y\n", "s.rif");
    CHECK(file.value("QUALITY")->text == "H");
    CHECK(file.values("view").size() == 2);
    REQUIRE(file.warnings().size() == 1);
    CHECK(file.warnings()[0] == "s.rif:3: QUALITY= is assigned twice: the last value counts");
    file.assign("QUALITY=L", {"QUALITY=L", 0});
    CHECK(file.value("QUALITY")->text == "L");
    CHECK(file.warnings().size() == 1);
    CHECK(is_rad_assignment("QUAL=High"));
    CHECK_FALSE(is_rad_assignment("QUAL"));
    CHECK_FALSE(is_rad_assignment("room=1.rad"));
}

TEST_CASE("words in quotes are one, and may begin anywhere") {
    const auto words = [](const std::string& text) { return words_of({text, {"s.rif", 4}}); };
    CHECK(words("a 'b c' \"!xform -rz 5 d.rad\"  e'f g'h ''") ==
          std::vector<std::string>{"a", "b c", "!xform -rz 5 d.rad", "ef gh", ""});
    CHECK(words("  ").empty());
    CHECK_THROWS_WITH_AS(words("a \"b c"), "s.rif:4: a quote that does not end: \"b c", InputError);
}

}  // namespace
}  // namespace lightwalk
