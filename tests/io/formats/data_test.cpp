#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "io/formats/decode.h"

using namespace lightwalk;

namespace {

DataArray decode(const std::string& text) {
    return decode_data(text, "t.dat");
}

void check_error(const std::string& text, const char* message) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS((void)decode(text), doctest::Contains(message), InputError);
}

}  // namespace

TEST_CASE("data files hold regular and irregular axes, comments, and surplus words") {
    const DataArray table = decode(
        "# luminaire\n2#dimensions\n0 90 2 # theta\n0 0 3\t0 45.5 180\r\n"
        "1 2 3\n+4e-1 .5 6. ignored words");
    REQUIRE(table.axes.size() == 2);
    CHECK(table.axes[0].origin == 0);
    CHECK(table.axes[0].extent == 90);
    CHECK(table.axes[0].count == 2);
    CHECK(table.axes[0].points.empty());
    CHECK(table.axes[1].points == std::vector<float>{0, 45.5f, 180});
    CHECK(table.axes[1].extent == 180);
    CHECK(table.values == std::vector<float>{1, 2, 3, 0.4f, 0.5f, 6});
    CHECK(decode("1 10 0 3 1 4 2").axes[0].extent == -10);
}

TEST_CASE("damaged data files are refused with file and line") {
    check_error("0 1", "t.dat:1: bad number of dimensions 0");
    check_error("7", "t.dat:1: bad number of dimensions 7");
    check_error("one", "t.dat:1: bad format in data file: found \"one\"");
    check_error("1.0 0 1 2 1 2", "t.dat:1: bad format in data file: found \"1.0\"");
    check_error("1\n0 1 1\n5",
                "t.dat:2: bad format in data file: found \"1\", expected at least 2 points");
    check_error("1\n0 1 -2\n5", "bad format in data file");
    check_error("1\n0 1 2\n5\nsix",
                "t.dat:4: bad format in data file: found \"six\", expected a value");
    check_error("1\n0 1 2\n5 nan", "bad format");
    check_error("1\n0 1 2\n5 1e39", "expected a number within the range of floats");
    check_error("1\n0 1 2\n5", "t.dat:2: unexpected EOF in data file");
    check_error("", "t.dat:1: unexpected EOF in data file");
    check_error("1 0 0 3  1 2 2  1 2 3", "coordinates are not monotonic");
    check_error("1 0 0 3  1 2 1  1 2 3", "coordinates are not monotonic");
    check_error("1 0 0 2  7 7  1 2", "all coordinates are equal");
    check_error("1 -3e38 3e38 2  1 2", "range too wide");
    check_error("1 0 1 2 5 " + std::string(64, '1'),
                "t.dat:1: word of 64 characters, expected at most 63");
}

TEST_CASE("counts of points are bounded by the words that follow") {
    check_error("1 0 1 2000000000 1 2 3", "unexpected EOF in data file");
    check_error("1 0 0 9223372036854775807 1 2 3", "unexpected EOF in data file");
    check_error("1 0 1 99999999999999999999999 1 2 3", "t.dat:1: ");
    check_error("6 0 1 9 0 1 9 0 1 9 0 1 9 0 1 9 0 1 9 1 2 3", "unexpected EOF in data file");
}

TEST_CASE("every cut of a data file is an error, not a crash") {
    const std::string text = "2 0 1 2 0 0 3 1 4 9 11 12 13 14 15 16";
    for (std::size_t n = 0; n + 2 < text.size(); ++n) {
        CAPTURE(n);
        CHECK_THROWS_AS((void)decode(text.substr(0, n)), InputError);
    }
    CHECK(decode(text).values.size() == 6);
}
