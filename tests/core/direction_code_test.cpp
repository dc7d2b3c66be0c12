#include "core/math/direction_code.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/tolerance.h"

namespace lightwalk {
using namespace test;

namespace {

TEST_CASE("direction codes of axes and of (0.6, 0.8, 0) are Radiance's") {
    CHECK(encode_direction({0, 0, 1}) == 8);
    CHECK(encode_direction({0, 0, -1}) == 12);
    CHECK(encode_direction({1, 0, 0}) == 16);
    CHECK(encode_direction({0, -1, 0}) == 26);
    CHECK(encode_direction({0.6, 0.8, 0}) == 222456);
    CHECK(encode_direction({0, 0, 0}) == 0);
    CHECK(decode_direction(0) == Vec3{});
    CHECK(decode_direction(8) == Vec3{0, 0, 1});
    const Vec3 d = decode_direction(222456);
    CHECK(d.x == printed(6, 0.600026));
    CHECK(d.y == printed(6, 0.799981));
    CHECK(d.z == 0);
}

TEST_CASE("decoding a code gives the direction back to 0.006 degrees, and its length is 1") {
    for (int i = 0; i < 40; ++i) {
        for (int j = 0; j < 80; ++j) {
            const double theta = (i + 0.37) * kPi / 40, phi = (j + 0.61) * kPi / 40;
            const Vec3 d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta)};
            const Vec3 back = decode_direction(encode_direction(d));
            CHECK(length(back) == rounded(1));
            CHECK(length(cross(back, d)) < 0.007 * kPi / 180);
            CHECK(dot(back, d) > 0);
        }
    }
}

TEST_CASE("damaged codes give finite vectors") {
    for (std::uint32_t bits = 0; bits < 32; ++bits) {
        const Vec3 d = decode_direction(0x7fffffe0U | bits);
        CHECK(std::isfinite(length(d)));
    }
}

}  // namespace
}  // namespace lightwalk
