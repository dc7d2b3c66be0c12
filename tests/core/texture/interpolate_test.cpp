#include "core/texture/interpolate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "io/formats/decode.h"
#include "io/picture/picture_data.h"
#include "tests/shared_data.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

double at(const std::string& data, std::vector<double> point) {
    return interpolate(decode_data(data, "t.dat"), point);
}

/// A flat picture whose stored pixel in row r, column c has bytes (10 r + c + 1, 100, 50 + blue *
/// r, 136).
std::string picture_bytes(const std::string& variables, const std::string& resolution, int rows,
                          int columns, int blue) {
    std::string bytes =
        "#?RADIANCE\n" + variables + "FORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n";
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            for (const int byte : {10 * r + c + 1, 100, 50 + blue * r, 136})
                bytes += static_cast<char>(byte);
        }
    }
    return bytes;
}

std::string conformance_picture(const std::string& setup) {
    if (setup.starts_with("1x1")) {
        return "#?RADIANCE\n\n-Y 1 +X 1\n\x07\x08\x09\x88";
    }
    if (setup.starts_with("PIC34")) return picture_bytes("", "-Y 4 +X 3", 4, 3, 0);
    if (setup.find("PIXASPECT=2") != std::string::npos)
        return picture_bytes("PIXASPECT=2\n", "-Y 3 +X 4", 3, 4, 1);
    if (setup.find("+Y 3 +X 4") != std::string::npos)
        return picture_bytes("", "+Y 3 +X 4", 3, 4, 1);
    if (setup.find("+X 3 -Y 4") != std::string::npos)
        return picture_bytes("", "+X 3 -Y 4", 3, 4, 1);
    return picture_bytes("", "-Y 3 +X 4", 3, 4, 1);
}

std::vector<double> numbers(std::string text) {
    for (char& c : text) {
        if (c == 'u' || c == 'v' || c == '=') c = ' ';
    }
    std::istringstream in(text);
    std::vector<double> values;
    for (double x = 0; in >> x;) values.push_back(x);
    return values;
}

bool close(double found, double expected, double tolerance) {
    return std::abs(found - expected) <= tolerance * std::max(1.0, std::abs(expected));
}

}  // namespace

TEST_CASE("inside a table interpolation is linear, one interval beyond it linear extrapolation") {
    const std::string table = "1  0 3 4  10 20 40 80";
    CHECK(at(table, {0}) == 10);
    CHECK(at(table, {2.5}) == 60);
    CHECK(at(table, {3}) == 80);
    CHECK(at(table, {-0.5}) == 5);
    CHECK(at(table, {4}) == 120);
}

TEST_CASE("farther out values decay like 1/distance, with a drop to one third above the table") {
    const std::string table = "1  0 3 4  10 20 40 80";
    CHECK(at(table, {4.01}) == printed(5, 39.867));
    CHECK(at(table, {6}) == rounded(24));
    CHECK(at(table, {10}) == printed(8, 13.333333));
    CHECK(at("1 0 10 3 1 4 2", {-5.1}) == printed(8, -1.9607843));
    CHECK(std::abs(at(table, {1e30})) < 100 / 1e30);
    CHECK(std::abs(at(table, {-1e30})) < 100 / 1e30);
}

TEST_CASE("irregular axes may rise or fall") {
    CHECK(at("1 0 0 3 0 1 4 10 20 40", {2}) == printed(8, 26.666667));
    CHECK(at("1 0 0 3 0 1 4 10 20 40", {7}) == rounded(60));
    CHECK(at("1 0 0 3 0 1 4 10 20 40", {8}) == rounded(18));
    CHECK(at("1 0 0 3 4 1 0 40 20 10", {7.01}) == printed(5, 59.801));
    CHECK(at("1 0 0 3 4 1 0 40 20 10", {20}) == rounded(11.25));
    const double step = at("1 0 0 4 9 5 5 1  1 2 3 4", {5});  // no division by the step's width
    CHECK(step >= 2);
    CHECK(step <= 3);
}

TEST_CASE("in several dimensions the first axis is the outermost") {
    const std::string table = "2 0 1 2 0 2 3  1 2 3 11 12 13";
    CHECK(at(table, {1, 0}) == 11);
    CHECK(at(table, {0, 2.5}) == 3.5);
    CHECK(at(table, {-3, 0}) == rounded(-3));
    CHECK(at("3 0 1 2 0 1 2 0 1 2  1 2 3 4 5 6 7 8", {.3, .6, .9}) == rounded(4.3));
    // f(a..f) = sum of the coordinates is linear, so that interpolation is exact in the whole
    // table.
    std::string six = "6";
    for (int d = 0; d < 6; ++d) six += " 0 1 2";
    for (int i = 0; i < 64; ++i)
        six += ' ' + std::to_string(__builtin_popcount(static_cast<unsigned>(i)));
    CHECK(at(six, {.1, .2, .3, .4, .5, .6}) == rounded(2.1));
}

TEST_CASE("outer neighbours of a weight up to 1e-6 contribute nothing") {
    const std::string table = "2 0 1 2 0 1 2  0 0 1e6 1e6";
    CHECK(at(table, {1e-6, 0}) == 0);
    CHECK(at(table, {2e-6, 0}) == rounded(2));
    CHECK(at("1 0 1 2 0 1e6", {1e-9}) == rounded(1e-3));  // the innermost ones are not left out
}

TEST_CASE("coordinates that are not numbers stay within the table's memory") {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for (const std::string table : {"1 0 3 4 1 2 3 4", "1 0 0 4 0 1 2 5 1 2 3 4"}) {
        for (const double x : {nan, inf, -inf, 1e300, -1e300}) {
            const double y = at(table, {x});
            CHECK((std::isnan(y) || std::abs(y) < 100 / 1e300));
        }
    }
}

TEST_CASE("data tables give Radiance's values") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    std::ifstream file(path);
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        std::string group, setup, probe, value;
        std::getline(in, group, '\t');
        std::getline(in, setup, '\t');
        std::getline(in, probe, '\t');
        std::getline(in, value, '\t');
        if (group != "brightdata") continue;
        CAPTURE(line);
        const std::size_t quote = setup.find('"');
        const std::string data = setup.substr(quote + 1, setup.rfind('"') - quote - 1);
        CHECK(close(at(data, numbers(probe)), std::stod(value), kFloatRounding));
        ++rows;
    }
    CHECK(rows == 54);
}

TEST_CASE("pictures as tables give Radiance's values, in all orientations") {
    LIGHTWALK_NEEDS_SHARED(path, "spec/3-conformance.tsv");
    std::ifstream file(path);
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        std::string group, setup, probe, value;
        std::getline(in, group, '\t');
        std::getline(in, setup, '\t');
        std::getline(in, probe, '\t');
        std::getline(in, value, '\t');
        if (group != "colorpict" || setup.find("noop") == std::string::npos) continue;
        CAPTURE(line);
        const PictureData picture = decode_picture(conformance_picture(setup), "t.hdr");
        const std::vector<double> where = numbers(probe), expected = numbers(value);
        REQUIRE(where.size() == 2);
        const Rgb found = interpolate(picture, where[0], where[1]);
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(close(static_cast<double>(found[k]), expected.at(k), kFloatRounding));
        ++rows;
    }
    CHECK(rows == 36);
}
