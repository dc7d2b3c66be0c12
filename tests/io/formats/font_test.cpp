#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/error.h"
#include "io/formats/decode.h"
#include "tests/shared_data.h"

using namespace lightwalk;

namespace {

void check_font_error(const std::string& text, const char* message) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS((void)decode_font(text, "t.fnt"), doctest::Contains(message), InputError);
}

}  // namespace

TEST_CASE("fonts hold glyphs, extents that include the cell's middle, and a mean width") {
    const Font font = decode_font(
        "32 0 # blank\n65 4  40 30 200 30 200 220 40 220\n66 3 130 140 150 140 150 160\n", "t.fnt");
    CHECK(font.glyphs[32].defined);
    CHECK(font.glyphs[32].vertices.empty());
    CHECK_FALSE(font.glyphs[67].defined);
    const Font::Glyph& a = font.glyphs[65];
    REQUIRE(a.vertices.size() == 4);
    CHECK(a.vertices[1][0] == 200);
    CHECK(a.vertices[1][1] == 30);
    CHECK(a.left == 40);
    CHECK(a.right == 200);
    CHECK(a.bottom == 30);
    CHECK(a.top == 220);
    CHECK(font.glyphs[66].left == 128);
    CHECK(font.glyphs[66].right == 150);
    CHECK(font.mean_width == (160 + 22) / 2);
    CHECK(decode_font("", "t.fnt").mean_width == 0);
}

TEST_CASE("the mean width of Radiance's helvet.fnt is 171") {
    LIGHTWALK_NEEDS_SHARED(path, "scenes/lib/helvet.fnt");
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    CHECK(decode_font(text, path).mean_width == 171);
}

TEST_CASE("damaged fonts are refused with file and line") {
    check_font_error(
        "65\n3 10 10 20 x",
        "t.fnt:2: font load error: a vertex coordinate \"x\", expected an integer from 0");
    check_font_error("65 3 10 10 20 256 30 30", "expected an integer from 0 to 255");
    check_font_error("65 3 10 10 20 -1 30 30", "expected an integer from 0 to 255");
    check_font_error("0 0",
                     "font load error: glyph number \"0\", expected an integer from 1 to 255");
    check_font_error("256 0", "font load error: glyph number");
    check_font_error("65 32001", "expected an integer from 0 to 32000");
    check_font_error("65 32000 1 2", "font load error: the file ends before a vertex");
    check_font_error("65", "font load error: the file ends before a vertex count");
    check_font_error("65 0\n66 0\n65 0", "t.fnt:3: font load error: duplicate glyph 65");
}
