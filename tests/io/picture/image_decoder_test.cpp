#include "io/picture/image_decoder.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/picture/image_encoder.h"
#include "io/picture/picture.h"
#include "tests/io/picture/small_images.h"

namespace lightwalk {
namespace {

/// IEC 61966-2-1.
double from_srgb(double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

void check_pixel(const Rgb& got, double r, double g, double b) {
    CHECK(static_cast<double>(got.r) == doctest::Approx(r).epsilon(1e-5));
    CHECK(static_cast<double>(got.g) == doctest::Approx(g).epsilon(1e-5));
    CHECK(static_cast<double>(got.b) == doctest::Approx(b).epsilon(1e-5));
}

std::string image_error(const std::string& bytes) {
    try {
        (void)decode_image(bytes, "x", ImageChannels::color);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("images: integers are sRGB, rows go upward, alpha multiplies nothing") {
    const PictureData data = decode_image(test::small_png(), "x", ImageChannels::color);
    REQUIRE(data.values.size() == 4);
    CHECK(data.axes[0].count == 2);
    CHECK(data.axes[1].extent == 1);
    check_pixel(data.values[0], 0, 0, 1);
    const double grey = from_srgb(188 / 255.0);
    check_pixel(data.values[1], grey, grey, grey);
    check_pixel(data.values[2], 1, 0, 0);
    check_pixel(data.values[3], 0, 1, 0);
}

TEST_CASE("images: what an encoder made of linear values is these again") {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 256; ++i)
        for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<std::uint8_t>(i));
    ImageRequest request;
    request.width = 16;
    request.height = 16;
    request.pixels = pixels.data();
    const PictureData data = decode_image(encode_image(request), "x", ImageChannels::color);
    REQUIRE(data.values.size() == 256);
    for (std::size_t y = 0; y < 16; ++y) {
        for (std::size_t x = 0; x < 16; ++x) {
            const double linear = from_srgb(static_cast<double>(y * 16 + x) / 255);
            check_pixel(data.values[(15 - y) * 16 + x], linear, linear, linear);
        }
    }
    request.format = "jpeg";
    request.quality = 100;
    const PictureData jpeg = decode_image(encode_image(request), "x", ImageChannels::color);
    const double middle = from_srgb((7 * 16 + 8) / 255.0);
    CHECK(static_cast<double>(jpeg.values[8 * 16 + 8].g) == doctest::Approx(middle).epsilon(0.05));
}

TEST_CASE("images: alpha and numbers are as stored, 16 bits too") {
    const PictureData alpha = decode_image(test::small_png(), "x", ImageChannels::alpha);
    check_pixel(alpha.values[0], 1, 1, 1);
    check_pixel(alpha.values[1], 0, 0, 0);
    const PictureData numbers = decode_image(test::wide_png(), "x", ImageChannels::numbers);
    check_pixel(numbers.values[0], 128 / 255.0, 64 / 255.0, 32 / 255.0);
    CHECK(numbers.axes[1].extent == 2);
    CHECK(image_aspect(test::wide_png(), "x") == 2);
    CHECK(image_aspect(encode_hdr({3, 1, std::vector<Rgb>(3)}, {}), "x") == 3);
    const PictureData tiff = decode_image(test::small_tiff(), "x", ImageChannels::numbers);
    REQUIRE(tiff.values.size() == 2);
    check_pixel(tiff.values[0], 1, 0, 32768 / 65535.0);
    check_pixel(tiff.values[1], 0, 1, 1000 / 65535.0);
}

TEST_CASE("images: TGA and BMP files, whose rows go upward and whose colours begin with blue") {
    for (const std::string& bytes : {test::small_tga(), test::small_bmp()}) {
        CAPTURE(bytes.substr(0, 2));
        CHECK(is_image(bytes));
        const PictureData data = decode_image(bytes, "x", ImageChannels::numbers);
        REQUIRE(data.values.size() == 2);
        check_pixel(data.values[0], 1, 0, 128 / 255.0);
        check_pixel(data.values[1], 0, 1, 64 / 255.0);
        CHECK(image_error(bytes.substr(0, bytes.size() - 5)).find("x: damaged ") == 0);
    }
    const PictureData alpha = decode_image(test::small_tga(), "x", ImageChannels::alpha);
    check_pixel(alpha.values[0], 1, 1, 1);
    check_pixel(alpha.values[1], 0, 0, 0);
}

TEST_CASE("images: WebP files, whose alpha multiplies nothing either") {
    for (const auto& [bytes, digits] :
         {std::pair(test::small_webp(), .012), std::pair(test::lossy_webp(), .03)}) {
        CHECK(is_image(bytes));
        CHECK(image_aspect(bytes, "x") == 2);
        const PictureData data = decode_image(bytes, "x", ImageChannels::numbers);
        REQUIRE(data.values.size() == 32);
        for (const Rgb& pixel : {data.values[0], data.values[31]}) {
            CHECK(std::abs(static_cast<double>(pixel.r) - 250 / 255.0) < digits);
            CHECK(std::abs(static_cast<double>(pixel.g) - 100 / 255.0) < digits);
            CHECK(std::abs(static_cast<double>(pixel.b) - 20 / 255.0) < digits);
        }
        const PictureData alpha = decode_image(bytes, "x", ImageChannels::alpha);
        check_pixel(alpha.values[5], 128 / 255.0, 128 / 255.0, 128 / 255.0);
        CHECK(image_error(bytes.substr(0, bytes.size() - 8)).find("x: damaged webp image") == 0);
    }
}

TEST_CASE("images: of few bytes no large picture is made") {
    constexpr auto kRefusal = "x: an image of no pixels, or of more than a file of this size holds";
    std::string webp = test::small_webp();
    for (const std::size_t at : {21, 22, 23, 24}) webp[at] = at == 24 ? '\x0f' : '\xff';
    CHECK(image_error(webp) == kRefusal);
    std::string canvas = test::lossy_webp();
    for (const std::size_t at : {25, 28}) canvas[at] = '\x7f';
    CHECK(image_error(canvas) == kRefusal);
    for (const std::string& small : {test::small_tga(), test::small_bmp()}) {
        std::string large = small;
        const std::size_t width = large.starts_with("BM") ? 18 : 12;
        large[width + 1] = large[width + (large.starts_with("BM") ? 5 : 3)] = '\x7f';
        CHECK(image_error(large) == kRefusal);
    }
}

TEST_CASE("images: what OpenImageIO does not read safely is refused") {
    std::string runs = test::small_bmp();
    runs[30] = 1;  // run-length encoded, for which memory would be taken first
    CHECK(!is_image(runs));
    std::string palette = test::small_tga();
    palette[1] = palette[2] = 1;
    CHECK(!is_image(palette));
    std::string animation = test::lossy_webp();
    animation[20] = 2;
    CHECK(!is_image(animation));
}

TEST_CASE("images: what is damaged is refused by its name") {
    CHECK(image_error("nothing") ==
          "x: neither a Radiance picture, nor PNG, JPEG, TIFF, WebP, TGA or BMP");
    const std::string png = test::small_png();
    CHECK(image_error(png.substr(0, 30)).find("x: damaged png image") == 0);
    std::string flipped = png;
    flipped[20] = '\x7f';  // the width
    CHECK(image_error(flipped).find("x: ") == 0);
    CHECK(image_error(std::string("\xff\xd8\xff\xe0")).find("x: damaged jpeg image") == 0);
    CHECK(image_error(test::small_tiff().substr(0, 60)).find("x: damaged tiff image") == 0);
}

}  // namespace lightwalk
