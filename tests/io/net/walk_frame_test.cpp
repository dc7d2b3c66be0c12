#include "io/net/walk_frame.h"

#include <doctest/doctest.h>

#include <vector>

using namespace lightwalk;

namespace {

std::string bytes_of(const std::vector<int>& values) {
    std::string bytes;
    for (const int value : values) bytes += static_cast<char>(value);
    return bytes;
}

}  // namespace

TEST_CASE("walk frame: the header is 48 bytes, little-endian, each where it belongs") {
    WalkFrameHeader header;
    header.frame = 0x04030201;
    header.view = 0x08070605;
    header.width = 0x0a09;
    header.height = 0x0c0b;
    header.whole = true;
    header.display = 0x0d;
    header.exposure = 0.15625f;  // 0x3e200000
    header.eye = {1, -2, 0.1};   // 0x3ff0..., 0xc000..., 0x3fb999999999999a
    const std::string expected = bytes_of(
        {'L', 'W',  'F', '1', 1, 2, 3,    4,    5,    6,    7,    8,    9,    10,   11,   12,
         1,   0x0d, 0,   0,   0, 0, 0x20, 0x3e, 0,    0,    0,    0,    0,    0,    0xf0, 0x3f,
         0,   0,    0,   0,   0, 0, 0,    0xc0, 0x9a, 0x99, 0x99, 0x99, 0x99, 0x99, 0xb9, 0x3f});
    CHECK(expected.size() == 48);
    CHECK(encode_walk_frame(header, {}) == expected);
}

TEST_CASE("walk frame: each flag is a bit of its own") {
    WalkFrameHeader header;
    CHECK(encode_walk_frame(header, {})[16] == 0);
    header.at_rest = true;
    CHECK(encode_walk_frame(header, {})[16] == 2);
    header.finished = true;
    CHECK(encode_walk_frame(header, {})[16] == 6);
    header.whole = true;
    CHECK(encode_walk_frame(header, {})[16] == 7);
    header.denoised = true;
    CHECK(encode_walk_frame(header, {})[16] == 15);
}

TEST_CASE("walk frame: pieces follow the header, each with its place, codec, length and bytes") {
    const std::string large(0x10203, 'x');
    const std::vector<WalkFramePiece> pieces{{1, 2, 3, 4, PieceCodec::jpeg, "abc"},
                                             {0x1234, 0xfffe, 256, 1, PieceCodec::png, large},
                                             {}};
    const std::string frame = encode_walk_frame({}, pieces);
    CHECK(frame.substr(18, 2) == bytes_of({3, 0}));
    const std::string first =
        bytes_of({1, 0, 2, 0, 3, 0, 4, 0, 1, 0, 0, 0, 3, 0, 0, 0, 'a', 'b', 'c'});
    const std::string second =
        bytes_of({0x34, 0x12, 0xfe, 0xff, 0, 1, 1, 0, 2, 0, 0, 0, 3, 2, 1, 0}) + large;
    const std::string third = bytes_of({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
    CHECK(frame.substr(48) == first + second + third);
}

TEST_CASE("walk frame: a message taken apart makes the same message again") {
    WalkFrameHeader header;
    header.frame = 0xfedcba98;
    header.view = 77;
    header.width = 300;
    header.height = 200;
    header.at_rest = header.denoised = true;
    header.display = 200;
    header.exposure = 0.15625f;
    header.eye = {1, -2, 0.1};
    const std::vector<WalkFramePiece> pieces{{0, 0, 160, 120, PieceCodec::jpeg, "abc"},
                                             {160, 0, 140, 200, PieceCodec::png, ""},
                                             {0, 0, 300, 200, PieceCodec::luminance, "defg"}};
    const std::string message = encode_walk_frame(header, pieces);
    const auto parts = parse_walk_frame(message);
    REQUIRE(parts);
    CHECK(parts->header.view == 77);
    CHECK(parts->header.eye.z == 0.1);
    REQUIRE(parts->pieces.size() == 3);
    CHECK(parts->pieces[2].bytes == "defg");
    CHECK(encode_walk_frame(parts->header, parts->pieces) == message);
}

TEST_CASE("walk frame: what is no frame is none") {
    WalkFrameHeader header;
    header.width = 20;
    header.height = 10;
    const auto frame = [&](WalkFramePiece piece) {
        return encode_walk_frame(header, std::vector<WalkFramePiece>{piece});
    };
    const std::string good = frame({5, 5, 15, 5, PieceCodec::jpeg, "abc"});
    REQUIRE(parse_walk_frame(good));
    for (std::size_t size = 0; size < good.size(); ++size)
        CHECK_FALSE(parse_walk_frame(std::string_view(good).substr(0, size)));
    CHECK_FALSE(parse_walk_frame(good + 'x'));
    CHECK_FALSE(parse_walk_frame('X' + good.substr(1)));
    CHECK_FALSE(parse_walk_frame(frame({6, 5, 15, 5, PieceCodec::jpeg, "abc"})));
    CHECK_FALSE(parse_walk_frame(frame({5, 6, 15, 5, PieceCodec::jpeg, "abc"})));
    for (const int codec : {0, 5})
        CHECK_FALSE(parse_walk_frame(frame({0, 0, 1, 1, static_cast<PieceCodec>(codec), "abc"})));
}
