#include "io/formats/binary_reader.h"

#include <doctest/doctest.h>

#include <string>

#include "tests/io/scene/binary_writer.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::printed;
using test::within;

using namespace std::string_literals;

constexpr double kMantissaStep = 0x1p-31;  // of mantissas from a half to 1: a unit, as a share

double real_of(const std::string& bytes) {
    return BinaryReader(bytes, "x", "octree").real();
}

TEST_CASE("portable floats are (m ± 0.5) / (2^31 - 1) · 2^e") {
    CHECK(real_of("\x3f\xff\xff\xff\x01"s) == 1);
    CHECK(real_of("\x5f\xff\xff\xff\x02"s) == within(kMantissaStep, 3));
    CHECK(real_of("\xa0\x00\x00\x01\x02"s) == within(kMantissaStep, -3));
    CHECK(real_of("\x63\xff\xff\xff\x07"s) == within(kMantissaStep, 100));
    CHECK(real_of("\x66\x66\x66\x65\x00"s) == printed(11, 0.79999999995));
    CHECK(real_of("\x66\x66\x66\x65\xfd"s) == printed(13, 0.09999999999418));
    CHECK(real_of("\x7f\xff\xff\xff\x7f"s) == printed(10, 1.701411835e38));
    CHECK(real_of("\x00\x00\x00\x00\x55"s) == 0);
}

TEST_CASE("writing a float and reading it back is exact to the last bit of its mantissa") {
    for (const double x : {1.0, -1.0, 0.1, -123.456, 1e-20, 3e30, 0.0}) {
        CAPTURE(x);
        CHECK(real_of(test::BinaryWriter().real(x).bytes()) == within(kMantissaStep, x));
    }
}

TEST_CASE("integers are big-endian and signed") {
    for (int size = 1; size <= 8; ++size) {
        for (const std::int64_t value : {0, 1, -1, 100, -128}) {
            const std::string bytes = test::BinaryWriter().integer(value, size).bytes();
            CHECK(BinaryReader(bytes, "x", "octree").integer(size) == value);
        }
    }
    CHECK(BinaryReader("\x01\x1f"s, "x", "octree").integer(2) == 287);
    CHECK(BinaryReader("\xff\xfe"s, "x", "octree").unsigned_integer(2) == 0xfffe);
}

TEST_CASE("reading past the end names the file") {
    CHECK_THROWS_WITH_AS(BinaryReader("abc", "x.oct", "octree").string(), "x.oct: truncated octree",
                         InputError);
    CHECK_THROWS_WITH_AS(static_cast<void>(BinaryReader("abc", "x.rtm", "mesh").integer(4)),
                         "x.rtm: truncated mesh", InputError);
    CHECK_THROWS_AS(BinaryReader("abc", "x", "mesh").skip(~std::uint64_t{0}), InputError);
}

}  // namespace
}  // namespace lightwalk
