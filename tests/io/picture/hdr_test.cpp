#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.h"
#include "io/picture/picture.h"
#include "tests/shared_data.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using test::float_rounded;

namespace {

Picture gradient(int width, int height) {
    Picture picture{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
        picture.pixels.push_back({static_cast<float>(i), 0.5f * static_cast<float>(i % 7), 3});
    }
    return picture;
}

std::string pixel_file(const std::string& variables) {
    return "#?RADIANCE\nrpict x.oct\n" + variables + "\n-Y 1 +X 1\n" + "\x40\x80\x20\x81";
}

}  // namespace

TEST_CASE("a picture's file begins with header and resolution line, as Radiance writes them") {
    const std::string bytes = encode_hdr(gradient(3, 2), {{"rpict a.oct", "VIEW= -vtv"}});
    const std::string head =
        "#?RADIANCE\nrpict a.oct\nVIEW= -vtv\nFORMAT=32-bit_rle_rgbe\n\n"
        "-Y        2 +X        3\n";
    CHECK(bytes.substr(0, head.size()) == head);
    CHECK(bytes.size() == head.size() + 6 * 4);
    CHECK(encode_hdr({}, {}) == "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y        0 +X        0\n");
}

TEST_CASE("header lines can't end the header or change the format") {
    const std::string bytes =
        encode_hdr(gradient(1, 1), {{"rpict -e 'a=1;\n\nb=2'", "", "FORMAT=float"}});
    PictureHeader header;
    (void)read_hdr(bytes, "t.hdr", &header);
    CHECK(header.lines == std::vector<std::string>{"rpict -e 'a=1;  b=2'"});
}

TEST_CASE("what was written reads back, to the format's step") {
    const Picture picture = gradient(40, 5);
    PictureHeader header;
    const Picture back = read_hdr(encode_hdr(picture, {{"a", "\tb"}}), "t.hdr", &header);
    CHECK(header.lines == std::vector<std::string>{"a", "\tb"});
    REQUIRE(back.width == 40);
    REQUIRE(back.height == 5);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const float step = max_component(picture.pixels[i]) / 128;
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(std::abs(back.pixels[i][k] - picture.pixels[i][k]) <= step);
    }
}

TEST_CASE("exposure and colour corrections multiply, and are undone") {
    PictureHeader header;
    const Picture picture = read_hdr(
        pixel_file("EXPOSURE=2\nEXPOSURE= 4.0e0\nCOLORCORR= 1 2 4\nPIXASPECT=2\n\tEXPOSURE=100\n"),
        "t.hdr", &header);
    const Rgb plain = read_hdr(pixel_file(""), "t.hdr").pixels[0];
    CHECK(plain == Rgb(64.5f / 128, 128.5f / 128, 32.5f / 128));
    CHECK(picture.pixels[0] == Rgb(plain.r / 8, plain.g / 16, plain.b / 32));
    CHECK(header.lines == std::vector<std::string>{"rpict x.oct", "PIXASPECT=2", "\tEXPOSURE=100"});
    for (const std::string bad : {"EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=x\n",
                                  "COLORCORR=1 2\n", "COLORCORR=1 0 1\n"}) {
        CAPTURE(bad);
        CHECK_THROWS_AS((void)read_hdr(pixel_file(bad), "t.hdr"), InputError);
    }
}

TEST_CASE("XYZE pictures become radiance: equal-energy white of 179 cd/m² is 1") {
    std::string white = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n";
    white += {static_cast<char>(179), static_cast<char>(179), static_cast<char>(179),
              static_cast<char>(136)};
    const Rgb color = read_hdr(white, "t.hdr").pixels[0];
    for (std::size_t k = 0; k < 3; ++k) CHECK(color[k] == float_rounded(179.5 / 179));
    CHECK_THROWS_AS((void)read_hdr(pixel_file("FORMAT=ascii\n"), "t.hdr"), InputError);
}

TEST_CASE("what was written as XYZE reads back as radiance") {
    const Rgb color{.25f, .5f, .125f};
    PictureHeader header;
    header.xyz = true;
    const std::string bytes = encode_hdr({1, 1, {color}}, header);
    CHECK(bytes.find("FORMAT=32-bit_rle_xyze\n\n") != std::string::npos);
    const Picture back = read_hdr(bytes, "xyz");
    // Half a step of 1/128 of the largest of X, Y and Z, times the largest row of the way back.
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(std::abs(back.pixels[0][i] - color[i]) < .5f * 4.2f / 128);
}

TEST_CASE("pictures by Radiance encode to the same bytes again") {
    LIGHTWALK_NEEDS_SHARED(folder, "reference/pictures");
    int pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".hdr") continue;
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        CAPTURE(entry.path().string());
        PictureHeader header;
        const Picture picture = read_hdr(bytes, entry.path().string(), &header);
        CHECK((encode_hdr(picture, header) == bytes));
        ++pictures;
    }
    CHECK(pictures == 18);
}
