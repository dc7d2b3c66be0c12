#include "core/cloud/pattern_code.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace lightwalk;

TEST_CASE("pattern code: within 2.2 percent over sixteen powers of two, monotone, 1 is exact") {
    CHECK(encode_pattern(1) == kNoPattern);
    CHECK(decode_pattern(kNoPattern) == 1);
    std::uint8_t last = 0;
    for (float brightness = 1.0f / 4000; brightness < 15; brightness *= 1.003f) {
        CAPTURE(brightness);
        const std::uint8_t code = encode_pattern(brightness);
        REQUIRE(decode_pattern(code) == doctest::Approx(brightness).epsilon(0.022));
        REQUIRE(code >= last);
        last = code;
    }
}

TEST_CASE("pattern code: what has no place has the nearest one, and nothing is black") {
    const float infinite = std::numeric_limits<float>::infinity();
    CHECK(decode_pattern(encode_pattern(0)) == 0);
    CHECK(decode_pattern(encode_pattern(-1)) == 0);
    CHECK(decode_pattern(encode_pattern(std::nanf(""))) == 0);
    CHECK(encode_pattern(1e-20f) == 0);
    CHECK(encode_pattern(1e20f) == 255);
    CHECK(encode_pattern(infinite) == 255);
}
