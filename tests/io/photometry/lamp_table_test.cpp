#include "io/photometry/lamp_table.h"

#include <doctest/doctest.h>

#include <string>

#include "core/error.h"
#include "io/files/library_path.h"

namespace lightwalk {
namespace {

std::string table_error(const std::string& text) {
    try {
        const LampTable table(text, "my.tab");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a lamp table: the first pattern that is found counts, brackets name another lamp") {
    const LampTable table(
        "# lamps\n /warm white/ .44 .4 .9\n\n%white\\>%\t.4 .39 1 # why\n"
        "/tube[s]*/ (Warm White)\n/a/ (b)\n/b/ (a)\n",
        "my.tab");
    CHECK(table.find("a WARM white lamp")->x == 0.44);
    CHECK(table.find("white")->x == 0.4);
    CHECK_FALSE(table.find("whitest"));
    CHECK(table.find("TUBES")->depreciation == 0.9);
    CHECK_FALSE(table.find("xbx"));  // which leads in a circle
    CHECK_FALSE(table.find(""));
}

TEST_CASE("a lamp table: mistakes have their line") {
    CHECK(table_error("/a/ .3 .3\n") == "my.tab:1: expected the depreciation from 0 to 1");
    CHECK(table_error("\n/a/ .3 2 1\n") == "my.tab:2: expected chromaticity y from 0 to 1");
    CHECK(table_error("/a/ .3 0 1\n") == "my.tab:1: chromaticity y is 0");
    CHECK(table_error("/a .3 .3 1\n") == "my.tab:1: the pattern has no second /");
    CHECK(table_error("/[a/ .3 .3 1\n") == "my.tab:1: bad pattern: not a regular expression");
    CHECK(table_error("/a\\{9999\\}/ .3 .3 1\n").find("my.tab:1: bad pattern, expected") == 0);
    CHECK(table_error("/a/ ()\n") == "my.tab:1: expected a lamp's name between ( )");
}

// As Radiance's ies2rad gives them for its own table.
TEST_CASE("the lamps of the library's table have the colours that ies2rad gives them") {
    const std::string path = LIGHTWALK_SOURCE "/io/library/lamp.tab";
    const LampTable table(read_file(path), path);
    struct Row {
        const char* name;
        Rgb color;
    };
    for (const Row& row : {Row{"deluxe warm white", {1.25694f, 0.747498f, 0.245023f}},
                           Row{"a cool-white lamp", {0.907836f, 0.863244f, 0.476357f}},
                           Row{"white xx fluor", {1.09105f, 0.804526f, 0.334f}},
                           Row{"daylight fluor", {0.672601f, 0.922381f, 0.827259f}},
                           Row{"clear mercury", {0.549861f, 0.924656f, 0.534221f}},
                           Row{"phosphor mercury", {0.748231f, 0.865605f, 0.333276f}},
                           Row{"MH", {0.975429f, 0.771599f, 0.375915f}},
                           Row{"xenon", {0.965565f, 1.00379f, 1.10173f}},
                           Row{"HID", {1.76243f, 0.644233f, 0.0164406f}},
                           Row{"low pressure sodium", {1.99899f, 0.597003f, 0}},
                           Row{"Quartz", {1.38244f, 0.911576f, 0.34969f}},
                           Row{"PAR", {1.48465f, 0.807884f, 0.232173f}},
                           Row{"D65white", {0.84012f, 1.05357f, 1.10013f}}}) {
        CAPTURE(row.name);
        const auto lamp = table.find(row.name);
        REQUIRE(lamp);
        const Rgb color = lamp->color();
        for (std::size_t c = 0; c < 3; ++c)  // six digits, and the rounding of the conversion
            CHECK(std::abs(color[c] - row.color[c]) < 1e-5f);
    }
}

}  // namespace lightwalk
