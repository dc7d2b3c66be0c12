#include "parallel/ranks/piece_codec.h"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <random>

#include "core/error.h"

using namespace lightwalk;

TEST_CASE("pieces are packed without loss, and smooth ones well") {
    const PixelRectangle block{5, 7, 105, 67};
    std::vector<PixelValue> values(block.pixels());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float x = static_cast<float>(i % 100);
        values[i] = {{.5F, .25F + x * 1e-3F, -0.0F}, 1e10F};
    }
    values[3].radiance.r = std::numeric_limits<float>::denorm_min();
    const std::string bytes = encode_piece(block, values);
    CHECK(bytes.size() < values.size() * sizeof(PixelValue) / 8);
    const std::vector<PixelValue> got = decode_piece(block, bytes);
    REQUIRE(got.size() == values.size());
    CHECK(std::memcmp(got.data(), values.data(), values.size() * sizeof(PixelValue)) == 0);
}

TEST_CASE("damaged pieces are refused") {
    const PixelRectangle block{0, 0, 8, 8};
    const std::string sound = encode_piece(block, std::vector<PixelValue>(64));
    CHECK_THROWS_AS((void)decode_piece(block, sound.substr(0, sound.size() - 1)), InputError);
    CHECK_THROWS_AS((void)decode_piece({0, 0, 8, 9}, sound), InputError);
    CHECK_THROWS_AS((void)decode_piece({0, 0, 8, 7}, sound), InputError);
    CHECK_THROWS_AS((void)decode_piece(block, "no piece"), InputError);
    CHECK_THROWS_AS((void)encode_piece(block, std::vector<PixelValue>(63)), InputError);
}
