#include "io/picture/jpeg.h"

#include <doctest/doctest.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

namespace {

using Bytes = std::vector<std::uint8_t>;

struct Image {
    int width = 0, height = 0;
    int sampling = -1;
    Bytes pixels;
};

Image decode(std::span<const std::uint8_t> jpeg) {
    const tjhandle handle = tjInitDecompress();
    Image image;
    int colours = 0;
    const auto size = static_cast<unsigned long>(jpeg.size());
    if (tjDecompressHeader3(handle, jpeg.data(), size, &image.width, &image.height, &image.sampling,
                            &colours) == 0) {
        image.pixels.resize(3 * static_cast<std::size_t>(image.width) *
                            static_cast<std::size_t>(image.height));
        (void)tjDecompress2(handle, jpeg.data(), size, image.pixels.data(), image.width, 0,
                            image.height, TJPF_RGB, TJFLAG_ACCURATEDCT);
    }
    (void)tjDestroy(handle);
    return image;
}

/// Smooth in brightness, with a coloured edge down the middle where `coloured`.
Bytes gradient(int width, int height, std::size_t stride, bool coloured) {
    Bytes pixels(stride * static_cast<std::size_t>(height), 77);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            std::uint8_t* p = pixels.data() + static_cast<std::size_t>(y) * stride +
                              3 * static_cast<std::size_t>(x);
            const int grey = 40 + 120 * x / width + 60 * y / height;
            const bool red = coloured && x > width / 2;
            p[0] = static_cast<std::uint8_t>(grey);
            p[1] = static_cast<std::uint8_t>(red ? grey / 3 : grey);
            p[2] = static_cast<std::uint8_t>(red ? grey / 4 : grey);
        }
    }
    return pixels;
}

/// Largest difference of a byte.
int difference(const Image& image, const Bytes& pixels, std::size_t stride) {
    int largest = 0;
    const auto row = 3 * static_cast<std::size_t>(image.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        for (std::size_t i = 0; i < row; ++i) {
            largest =
                std::max(largest, std::abs(image.pixels[y * row + i] - pixels[y * stride + i]));
        }
    }
    return largest;
}

}  // namespace

TEST_CASE("jpeg: what is compressed is what is seen again, the better the higher the quality") {
    JpegCompressor compressor;
    const Bytes pixels = gradient(101, 67, 3 * 101, false);
    std::size_t smaller = 0;
    for (const auto& [quality, bound] : {std::pair(30, 12), {75, 5}, {95, 2}, {100, 2}}) {
        CAPTURE(quality);
        const auto jpeg = compressor.compress({pixels.data(), 101, 67, 303}, quality);
        const Image image = decode(jpeg);
        REQUIRE(image.width == 101);
        REQUIRE(image.height == 67);
        CHECK(difference(image, pixels, 303) <= bound);
        CHECK(jpeg.size() >= smaller);
        smaller = jpeg.size();
    }
}

TEST_CASE("jpeg: colours have their full resolution from quality 85 on") {
    JpegCompressor compressor;
    const Bytes pixels = gradient(64, 64, 192, true);
    CHECK(decode(compressor.compress({pixels.data(), 64, 64, 192}, 84)).sampling == TJSAMP_420);
    const Image fine = decode(compressor.compress({pixels.data(), 64, 64, 192}, 85));
    CHECK(fine.sampling == TJSAMP_444);
    const Image finest = decode(compressor.compress({pixels.data(), 64, 64, 192}, 100));
    CHECK(difference(finest, pixels, 192) <= 3);  // the edge, too
}

TEST_CASE("jpeg: a rectangle of a larger picture, and sizes that are no multiple of blocks") {
    JpegCompressor compressor;
    const std::size_t stride = 1000;
    for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {300, 5}, {16, 16}}) {
        CAPTURE(width);
        const Bytes pixels = gradient(width, height, stride, false);
        const Image image = decode(compressor.compress({pixels.data(), width, height, stride}, 95));
        REQUIRE(image.width == width);
        REQUIRE(image.height == height);
        CHECK(difference(image, pixels, stride) <= 4);
    }
}

TEST_CASE("jpeg: what was compressed before does not matter") {
    JpegCompressor used, fresh;
    const Bytes large = gradient(200, 150, 600, true), small = gradient(20, 15, 60, false);
    (void)used.compress({large.data(), 200, 150, 600}, 95);
    const auto a = used.compress({small.data(), 20, 15, 60}, 50);
    const auto b = fresh.compress({small.data(), 20, 15, 60}, 50);
    CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    JpegCompressor moved = std::move(used);
    const auto c = moved.compress({small.data(), 20, 15, 60}, 50);
    CHECK(std::equal(c.begin(), c.end(), b.begin(), b.end()));
}

TEST_CASE("jpeg: a picture without pixels or of a size beyond the format is an error") {
    JpegCompressor compressor;
    const Bytes pixels(3 * 70'000, 1);
    CHECK_THROWS_WITH_AS((void)compressor.compress({pixels.data(), 0, 4, 0}, 50),
                         "cannot encode jpeg: picture of 0 x 4 pixels", InputError);
    CHECK_THROWS_AS((void)compressor.compress({pixels.data(), 70'000, 1, 210'000}, 50), InputError);
    CHECK_FALSE(compressor.compress({pixels.data(), 2, 2, 6}, 50).empty());
}
