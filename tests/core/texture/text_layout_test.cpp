#include "core/texture/text_layout.h"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "core/error.h"
#include "io/formats/decode.h"
#include "tests/shared_data.h"

using namespace lightwalk;

namespace {

/// A: a square with margins; B: a triangle; C: a ring, its hole joined to the outside by a slit.
std::shared_ptr<const Font> test_font() {
    return std::make_shared<const Font>(
        decode_font("32 0\n65 4  40 30 200 30 200 220 40 220\n66 3  20 20 240 20 130 240\n"
                    "67 10  10 10 250 10 250 250 10 250 10 10 60 60 60 200 200 200 200 60 60 60\n",
                    "t.fnt"));
}

TextLayout layout(const std::vector<std::string>& lines, std::optional<double> spacing) {
    return TextLayout(lines, test_font(), {0, 0, 0}, {1, 0, 0}, {0, -1, 0}, spacing);
}

}  // namespace

TEST_CASE("text cells are spanned by the motion vectors, the origin is their upper left corner") {
    const TextLayout text({"A", " A"}, test_font(), {5, 6, 7}, {0, 0, 2}, {0, -3, 0});
    const auto inside = [&](double column, double line) {
        return text.inside({5, 6 - 3 * line, 7 + 2 * column});
    };
    CHECK(inside(0.5, 0.5));
    CHECK(inside(1.5, 1.5));
    CHECK_FALSE(inside(0.5, 1.5));
    CHECK_FALSE(inside(1.5, 0.5));
    // A's square: 40..200 of 255 across, 30..220 up.
    CHECK_FALSE(inside(39.0 / 255, 0.5));
    CHECK(inside(41.0 / 255, 0.5));
    CHECK(inside(199.0 / 255, 0.5));
    CHECK_FALSE(inside(201.0 / 255, 0.5));
    CHECK_FALSE(inside(0.5, 1 - 29.0 / 255));
    CHECK(inside(0.5, 1 - 31.0 / 255));
    CHECK_FALSE(inside(-0.5, 0.5));
    CHECK_FALSE(inside(0.5, -0.5));
    CHECK_FALSE(inside(0.5, 2.5));
}

TEST_CASE("motion vectors need not be perpendicular") {
    const Vec3 right{1, 0.2, 0}, down{-0.3, -1, 0};
    const TextLayout slanted({"AB"}, test_font(), {}, right, down);
    const TextLayout straight = layout({"AB"}, std::nullopt);
    int inside = 0;
    for (int i = 0; i < 40; ++i) {
        for (int j = 0; j < 20; ++j) {
            const double x = (i + 0.5) / 20, y = (j + 0.5) / 20;
            const bool expected = straight.inside({x, -y, 0});
            CHECK(slanted.inside(x * right + y * down + Vec3{0, 0, 3}) == expected);
            inside += expected ? 1 : 0;
        }
    }
    CHECK(inside > 200);
}

TEST_CASE("vectors that span no plane are illegal") {
    const auto make = [](const Vec3& right, const Vec3& down) {
        return TextLayout({"A"}, test_font(), {}, right, down);
    };
    CHECK_THROWS_WITH_AS(make({1, 0, 0}, {2, 0, 0}), doctest::Contains("illegal motion vector"),
                         InputError);
    CHECK_THROWS_WITH_AS(make({}, {0, 1, 0}), doctest::Contains("illegal motion vector"),
                         InputError);
    CHECK_THROWS_WITH_AS(make({1, 0, 0}, {}), doctest::Contains("illegal motion vector"),
                         InputError);
}

TEST_CASE("slits to holes leave the hole empty") {
    const TextLayout text = layout({"C"}, std::nullopt);
    CHECK(text.inside({0.1, -0.5, 0}));
    CHECK_FALSE(text.inside({0.5, -0.5, 0}));
    CHECK(text.inside({0.9, -0.5, 0}));
}

TEST_CASE(
    "characters without a glyph, empty lines and extreme spacings draw nothing and do no harm") {
    for (const double spacing : {0.0, 0.5, -0.5, 1e300, -1e300}) {
        CAPTURE(spacing);
        const TextLayout text = layout({"", "\x01\xff", "xyz", "   "}, spacing);
        for (int line = 0; line < 5; ++line) {
            for (const double x : {0.0, 0.5, 3.0, 1e300})
                CHECK_FALSE(text.inside({x, -0.5 - line, 0}));
        }
    }
    CHECK_FALSE(layout({}, 0.1).inside({0.5, -0.5, 0}));
}

TEST_CASE("text gives Radiance's foreground and background for every spacing") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    std::ifstream file(path);
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("brighttext\t")) continue;
        CAPTURE(line);
        REQUIRE(line.find("lines \"A BC\",\"B   A\",\"CA\"; A 0 0 0 R 1 0 0 D 0 -1 0;") !=
                std::string::npos);
        std::istringstream in(line.substr(line.find("spacing ") + 8));
        std::string spacing, point, expected;
        double x = 0, y = 0;
        in >> spacing >> point >> x >> y >> expected;
        REQUIRE(point == "point");
        const TextLayout text =
            layout({"A BC", "B   A", "CA"},
                   spacing == "absent" ? std::nullopt : std::optional(std::stod(spacing)));
        CHECK(text.inside({x, y, 0}) == (expected == "fore"));
        ++rows;
    }
    CHECK(rows == 90);
}
