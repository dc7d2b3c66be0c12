#include "io/picture/scanline.h"

#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

namespace {

std::string bytes_of(std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) bytes += static_cast<char>(value);
    return bytes;
}

std::string encode(const std::vector<Rgbe>& pixels) {
    std::string bytes;
    encode_scanline(pixels, bytes);
    return bytes;
}

std::vector<Rgbe> decode(std::string bytes, std::size_t width) {
    std::vector<Rgbe> pixels(width);
    std::string_view rest = bytes;
    decode_scanline(rest, pixels);
    CHECK(rest.empty());
    return pixels;
}

/// A scanline whose red bytes are given and whose other components are 0.
std::vector<Rgbe> reds(const std::string& red) {
    std::vector<Rgbe> pixels;
    for (const char c : red) pixels.push_back({static_cast<unsigned char>(c), 0, 0, 0});
    return pixels;
}

/// Records of the red component in the coded scanline.
std::string coded_red(const std::string& red) {
    const std::string bytes = encode(reds(red));
    const std::string zeros = encode(reds(std::string(red.size(), '\0')));
    return bytes.substr(4, bytes.size() - 4 - (zeros.size() - 4) / 4 * 3);
}

void check_error(const std::string& bytes, std::size_t width, const char* message) {
    std::vector<Rgbe> pixels(width);
    std::string_view rest = bytes;
    CHECK_THROWS_WITH_AS(decode_scanline(rest, pixels), message, InputError);
}

}  // namespace

TEST_CASE("runs of four and more are coded, two or three equal bytes alone as well") {
    CHECK(coded_red("abcdefghijklmnopq") ==
          "\x11"
          "abcdefghijklmnopq");
    CHECK(coded_red("aaaaaaaaaaaaaaaaa") ==
          "\x91"
          "a");
    CHECK(coded_red("abbbcccccccccccccc") ==
          "\x04"
          "abbb"
          "\x8e"
          "c");
    CHECK(coded_red("bbbcccccccccccccc") ==
          "\x83"
          "b"
          "\x8e"
          "c");
    CHECK(coded_red("bbcccccccccccccccc") ==
          "\x82"
          "b"
          "\x90"
          "c");
    CHECK(coded_red("bccccccccccccccccc") ==
          "\x01"
          "b"
          "\x91"
          "c");
    CHECK(coded_red("cccccccccccccccbbdd") ==
          "\x8f"
          "c"
          "\x04"
          "bbdd");
}

TEST_CASE("runs end at 127 bytes, literals at 128") {
    CHECK(coded_red(std::string(130, 'a')) ==
          "\xff"
          "a"
          "\x83"
          "a");
    std::string row(254, 'a');
    row.push_back('b');
    CHECK(coded_red(row) ==
          "\xff"
          "a"
          "\xff"
          "a"
          "\x01"
          "b");
    std::string varied;
    for (int i = 0; i < 130; ++i) varied += static_cast<char>('a' + i % 7);
    CHECK(coded_red(varied) == "\x80" + varied.substr(0, 128) + "\x02" + varied.substr(128));
}

TEST_CASE("short and very long scanlines are flat") {
    CHECK(encode(reds("abcdefghijklmnop")).size() == 16 * 4);
    CHECK(encode(reds("abcdefghijklmnopq")).substr(0, 4) == bytes_of({2, 2, 0, 17}));
    CHECK(encode(std::vector<Rgbe>(32767)).substr(0, 4) == bytes_of({2, 2, 127, 255}));
    CHECK(encode(std::vector<Rgbe>(32768)).size() == 32768 * 4);
}

TEST_CASE("decoding undoes encoding for every width") {
    std::mt19937 random(1);
    for (const std::size_t width : {1u, 2u, 7u, 8u, 16u, 17u, 100u, 1000u, 32767u, 32768u}) {
        CAPTURE(width);
        for (const unsigned variety : {1u, 2u, 5u, 250u}) {
            std::vector<Rgbe> pixels(width);
            for (Rgbe& p : pixels) {
                const auto byte = [&] {
                    return static_cast<unsigned char>(3 + random() % variety);
                };
                p = random() % 3 == 0 && &p != pixels.data() ? *(&p - 1)
                                                             : Rgbe{byte(), byte(), byte(), byte()};
            }
            CHECK(decode(encode(pixels), width) == pixels);
        }
    }
}

TEST_CASE("readers take the new form of any width, with empty literals") {
    const std::string bytes =
        bytes_of({2, 2, 0, 8, 0x88, 5, 0, 0x84, 6, 4, 1, 2, 3, 4, 0x88, 7, 0x88, 128});
    const std::vector<Rgbe> pixels = decode(bytes, 8);
    CHECK(pixels[0] == Rgbe{5, 6, 7, 128});
    CHECK(pixels[7] == Rgbe{5, 4, 7, 128});
}

TEST_CASE("in the old form 1 1 1 k repeats, directly following counts are the higher bytes") {
    const std::string once = bytes_of({9, 8, 7, 128, 1, 1, 1, 2, 5, 5, 5, 129});
    CHECK(decode(once, 4) ==
          std::vector<Rgbe>{{9, 8, 7, 128}, {9, 8, 7, 128}, {9, 8, 7, 128}, {5, 5, 5, 129}});
    const std::string twice =
        bytes_of({9, 8, 7, 128, 1, 1, 1, 3, 1, 1, 1, 2, 5, 5, 5, 129, 1, 1, 1, 1});
    const std::vector<Rgbe> pixels = decode(twice, 1 + 3 + 512 + 1 + 1);
    CHECK(pixels[515] == Rgbe{9, 8, 7, 128});
    CHECK(pixels[516] == Rgbe{5, 5, 5, 129});
    CHECK(pixels[517] == Rgbe{5, 5, 5, 129});
    CHECK(decode(bytes_of({9, 8, 7, 128, 1, 1, 1, 200}), 3).size() ==
          3);  // repeats beyond the end are dropped
}

TEST_CASE("damaged scanlines are refused") {
    check_error("", 3, "the data end within a scanline");
    check_error(bytes_of({5, 5, 5, 5, 6, 6}), 2, "the data end within a scanline");
    check_error(bytes_of({2, 2, 0, 9}), 8, "scanline of length 9, expected 8");
    check_error(bytes_of({2, 2, 0, 8, 0x89, 5}), 8, "a run is longer than its scanline");
    check_error(bytes_of({2, 2, 0, 8, 9, 1, 2, 3}), 8, "a run is longer than its scanline");
    check_error(bytes_of({2, 2, 0, 8, 0x88}), 8, "the data end within a scanline");
    check_error(bytes_of({2, 2, 0, 8, 8, 1, 2, 3}), 8, "the data end within a scanline");
    std::string repeats = bytes_of({9, 8, 7, 128});
    for (int i = 0; i < 5; ++i) repeats += bytes_of({1, 1, 1, 0});
    check_error(repeats, 3, "a repeat count of more than four bytes");
}
