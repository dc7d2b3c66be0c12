#include "core/model/transform_args.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tolerance.h"

namespace lightwalk {
using namespace test;

namespace {

ParsedTransform parse(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return parse_transform(words);
}

void check_near(const Vec3& a, const Vec3& b) {
    CHECK(a.x == rounded(b.x));
    CHECK(a.y == rounded(b.y));
    CHECK(a.z == rounded(b.z));
}

TEST_CASE(
    "each operation moves the point (1, 2, 3) as the manual says, and its scale factor is right") {
    const double h = std::sqrt(0.5);  // cos 45 = sin 45
    struct Row {
        const char* words;
        Vec3 image;
        double scale;
    };
    const Row rows[] = {{"-t 10 20 30", {11, 22, 33}, 1},
                        {"-rx 45", {1, h * 2 - h * 3, h * 2 + h * 3}, 1},
                        {"-ry 45", {h + h * 3, 2, -h + h * 3}, 1},
                        {"-rz 45", {h - h * 2, h + h * 2, 3}, 1},
                        {"-s 2", {2, 4, 6}, 2},
                        {"-s -2", {-2, -4, -6}, -2},
                        {"-mx", {-1, 2, 3}, -1},
                        {"-my", {1, -2, 3}, -1},
                        {"-mz", {1, 2, -3}, -1}};
    for (const Row& row : rows) {
        CAPTURE(row.words);
        const Transform t = parse(row.words).transform;
        check_near(t.forward.point({1, 2, 3}), row.image);
        CHECK(t.scale == row.scale);
    }
}

TEST_CASE("operations apply left to right") {
    check_near(parse("-t 1 0 0 -rz 90").transform.forward.point({}), {0, 1, 0});
    check_near(parse("-rz 90 -t 1 0 0").transform.forward.point({}), {1, 0, 0});
}

TEST_CASE("the inverse undoes the transform") {
    const Transform t = parse("-rx 10 -t 1 2 3 -s .5 -my -i 3 -rz 20 -t 4 5 6").transform;
    check_near(t.inverse.point(t.forward.point({7, -8, 9})), {7, -8, 9});
    CHECK(t.scale == -0.5);
}

TEST_CASE("-i n repeats what follows, up to the next -i") {
    check_near(parse("-i 3 -t 1 0 0").transform.forward.point({}), {3, 0, 0});
    check_near(parse("-i 3 -t 1 0 0 -i 1 -t 0 5 0").transform.forward.point({}), {3, 5, 0});
    check_near(parse("-t 0 0 1 -i 2 -rz 90 -t 1 0 0").transform.forward.point({}), {1, 1, 1});
    CHECK(parse("-i 3 -s 2").transform.scale == 8);
    CHECK(parse("-i 0 -s 2").transform.is_identity());
    CHECK(parse("-i -4 -s 2").transform.is_identity());
    CHECK(parse("-i 1000000000 -mx").transform.is_identity());  // at once
}

TEST_CASE("parsing stops at the first word that is no complete operation") {
    CHECK(parse("").words == 0);
    CHECK(parse("-t 1 2 3 file.rad").words == 4);
    CHECK(parse("-t 1 2").words == 0);
    CHECK(parse("-rz 1 -t 1 2 x").words == 2);
    CHECK(parse("-tx 1").words == 0);
    CHECK(parse("-rw 1").words == 0);
    CHECK(parse("-s 0").words == 0);
    CHECK(parse("-s 1e-320").words == 0);  // its inverse is infinite
    CHECK(parse("-mx -i 1.5 -my").words == 1);
    CHECK(parse("-mx -i").words == 1);
    CHECK(parse("-mx -a 3").words == 1);
}

TEST_CASE("numbers are strictly decimal") {
    double value = -1;
    for (const char* good :
         {"1", "+1", "-1", "1.", ".5", "-.5e3", "1e+3", "1E-3", " 2", "\t+3.25"}) {
        CAPTURE(good);
        CHECK(parse_real(good, value));
        CHECK(value == std::strtod(good, nullptr));
    }
    for (const char* bad : {"", ".", "-", "+", "+-1", "++1", "1e", "1e+", "0x1", "nan", "inf", "1,",
                            "1 ", "1d3", "1.2.3", "e5", "1e999", "-1e999"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_real(bad, value));
    }
    CHECK(parse_real("1e-999", value));
    CHECK(value == 0);
    long count = -1;
    CHECK(parse_integer("+12", count));
    CHECK(count == 12);
    CHECK(parse_integer("-3", count));
    CHECK(count == -3);
    for (const char* bad : {"", "1.0", "1e3", "-", "99999999999999999999", "1 ", "0x1"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_integer(bad, count));
    }
}

TEST_CASE("a memo answers as the parser does, and tells words from words") {
    TransformMemo memo;
    const std::vector<std::vector<std::string>> all{{},
                                                    {"-t", "1", "2", "3"},
                                                    {"-t", "12", "3"},
                                                    {"-rz", "30", "-s", "2"},
                                                    {"-rz", "30", "-s"},
                                                    {""},
                                                    {"-i", "2", "-t", "1", "2", "3"}};
    for (int round = 0; round < 2; ++round) {
        for (const std::vector<std::string>& words : all) {
            const ParsedTransform right = parse_transform(words), told = memo.parse(words);
            CHECK(told.words == right.words);
            CHECK(told.transform.forward == right.transform.forward);
            CHECK(told.transform.inverse == right.transform.inverse);
            CHECK(told.transform.scale == right.transform.scale);
        }
    }
}

TEST_CASE("transform options are told from other words exactly") {
    for (const char* option : {"-t", "-s", "-i", "-rx", "-ry", "-rz", "-mx", "-my", "-mz"}) {
        CHECK(is_transform_option(option));
    }
    for (const char* other : {"-", "-tx", "-r", "-m", "-rxx", "t", "-a", "", "-rw", "-1"}) {
        CHECK_FALSE(is_transform_option(other));
    }
}

}  // namespace
}  // namespace lightwalk
