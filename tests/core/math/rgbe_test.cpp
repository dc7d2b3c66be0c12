#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "core/math/rgbe.h"

using namespace lightwalk;

TEST_CASE("RGBE bytes and decoded values equal Radiance's") {
    struct Row {
        Rgb color;
        Rgbe bytes;
        std::array<double, 3> decoded;
    };
    const std::array<Row, 6> rows{{
        {{1, 1, 1}, {0x80, 0x80, 0x80, 0x81}, {1.00390625, 1.00390625, 1.00390625}},
        {{0.5f, 0.25f, 0.1f}, {0x80, 0x40, 0x19, 0x80}, {0.501953125, 0.251953125, 0.099609375}},
        {{100, 50, 10}, {0xc8, 0x64, 0x14, 0x87}, {100.25, 50.25, 10.25}},
        {{0.001f, 0.002f, 0}, {0x41, 0x83, 0, 0x78}, {0.00099945, 0.00200653, 0.00000763}},
        {{-1, 0.5f, 0}, {0, 0x80, 0, 0x80}, {0.00195313, 0.50195313, 0.00195313}},
        {{1e6f, 1, 1}, {0xf4, 0, 0, 0x94}, {1001472, 2048, 2048}},
    }};
    for (const Row& row : rows) {
        CAPTURE(row.color.r);
        CHECK(encode_rgbe(row.color) == row.bytes);
        const Rgb decoded = decode_rgbe(row.bytes);
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(std::abs(static_cast<double>(decoded[k]) - row.decoded[k]) <
                  1e-8 + 1e-7 * row.decoded[k]);
        }
    }
}

TEST_CASE("black is four zero bytes, and only an exponent of 0 decodes to exactly 0") {
    CHECK(encode_rgbe({}) == Rgbe{});
    CHECK(encode_rgbe({-1, -2, -3}) == Rgbe{});
    CHECK(encode_rgbe({1e-33f, 0, 0}) == Rgbe{});
    CHECK(decode_rgbe({1, 2, 3, 0}) == Rgb{});
    CHECK(decode_rgbe({0, 0, 0, 1}).r > 0);
}

TEST_CASE("encoding undoes decoding for every pixel that an encoder writes") {
    for (int e = 23; e <= 255; ++e) {  // below, values are black
        for (int m = 128; m <= 255; ++m) {
            const auto byte = [](int value) { return static_cast<unsigned char>(value); };
            const Rgbe pixel{byte(m), byte(255 - m), byte(m / 2), byte(e)};
            REQUIRE(encode_rgbe(decode_rgbe(pixel)) == pixel);
        }
    }
}

TEST_CASE("the error of the largest channel is at most 1/256, and has no bias") {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-20, 20);
    double sum = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
        const float x = std::exp2(exponent(random));
        const double error = static_cast<double>(decode_rgbe(encode_rgbe({x, 0, 0})).r / x) - 1;
        REQUIRE(std::abs(error) <= 1 / 256.0);
        sum += error;
    }
    // Uniform in the step of 1/128 to 1/256: standard deviation below 1/256/sqrt(3).
    CHECK(std::abs(sum / kSamples) < 4 / 256.0 / std::sqrt(3.0 * kSamples));
}

TEST_CASE("numbers beyond the format never wrap the exponent") {
    const float inf = std::numeric_limits<float>::infinity(),
                nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(encode_rgbe({inf, 1, -inf}) == Rgbe{255, 0, 0, 255});
    CHECK(encode_rgbe({3e38f, 1.5e38f, 0}) == Rgbe{255, 225, 0, 255});
    CHECK(encode_rgbe({nan, 1, nan}) == Rgbe{0, 0x80, 0, 0x81});
    CHECK(encode_rgbe({nan, nan, nan}) == Rgbe{});
    CHECK(encode_rgbe({std::nextafter(0x1p127f, 0.0f), 0, 0}) == Rgbe{255, 0, 0, 255});
}
