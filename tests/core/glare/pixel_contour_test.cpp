#include "core/glare/pixel_contour.h"

#include <doctest/doctest.h>

#include <string>

using namespace lightwalk;

namespace {

/// Pixels marked by # in rows from the top.
std::vector<PixelPlace> drawn(const std::vector<std::string>& rows) {
    std::vector<PixelPlace> places;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (std::size_t x = 0; x < rows[row].size(); ++x) {
            if (rows[row][x] == '#')
                places.push_back({static_cast<int>(x), static_cast<int>(rows.size() - 1 - row)});
        }
    }
    return places;
}

/// Of a closed line of corners, positive when it runs counterclockwise [pixels].
double area_in(const std::vector<PixelPlace>& line) {
    double twice = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const PixelPlace &a = line[i], &b = line[(i + 1) % line.size()];
        twice += a.x * b.y - b.x * a.y;
    }
    return twice / 2;
}

}  // namespace

TEST_CASE("contour: around a pixel, counterclockwise from its lower left corner") {
    const std::vector<PixelPlace> one{{3, 5}};
    CHECK(pixel_contour(one) == std::vector<PixelPlace>{{3, 5}, {4, 5}, {4, 6}, {3, 6}});
    CHECK(pixel_contour({}).empty());
}

TEST_CASE("contour: encloses the pixels and their holes, each step along one pixel") {
    struct Case {
        std::vector<std::string> rows;
        double area;
        std::size_t length;
    };
    for (const Case& c : std::vector<Case>{{{"##", "##"}, 4, 8},
                                           {{"###", "#.#", "###"}, 9, 12},
                                           {{"#..", "#..", "###"}, 5, 12},
                                           {{".#.", "###", ".#."}, 5, 12},
                                           {{"#.", ".#"}, 2, 8},
                                           {{".#", "#."}, 2, 8},
                                           {{"#.#.#", "#####"}, 8, 18}}) {
        const std::vector<PixelPlace> line = pixel_contour(drawn(c.rows));
        CAPTURE(c.rows[0]);
        CHECK(area_in(line) == c.area);
        CHECK(line.size() == c.length);
        for (std::size_t i = 0; i < line.size(); ++i) {
            const PixelPlace &a = line[i], &b = line[(i + 1) % line.size()];
            CHECK(std::abs(a.x - b.x) + std::abs(a.y - b.y) == 1);
        }
    }
}

TEST_CASE("contour: pixels apart are widened just so far that they touch") {
    // A gap of 1 closes when both sides grow by 1: 5 x 3 pixels.
    CHECK(area_in(pixel_contour(drawn({"#.#"}))) == 15);
    // A gap of 4 needs 2 on each side: 10 x 5.
    CHECK(area_in(pixel_contour(drawn({"#....#"}))) == 50);
}
