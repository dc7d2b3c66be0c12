#include "io/picture/encode_picture.h"

#include <array>
#include <cassert>
#include <cstdint>

#include "io/formats/header.h"
#include "io/picture/image_encoder.h"

namespace lightwalk {
namespace {

[[maybe_unused]] std::size_t pixel_count(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

std::string encode_with_header(ImageRequest request, const PictureHeader& header) {
    std::string history, date;
    for (const std::string& line : header.lines) {
        history += line + '\n';
        if (const auto taken = header_variable(line, "CAPDATE")) date = *taken;
    }
    request.history = history.c_str();
    request.date = date.c_str();
    return encode_image(request);
}

std::string encode_display_image(ImageRequest request, const Picture& picture,
                                 const DisplayTone& tone) {
    assert(picture.pixels.size() == pixel_count(picture.width, picture.height));
    const std::vector<std::array<std::uint8_t, 3>> pixels = display_pixels(picture, tone);
    request.width = picture.width;
    request.height = picture.height;
    request.pixels = pixels.data();
    return encode_image(request);
}

}  // namespace

std::string encode_exr(const Picture& picture, const PictureHeader& header) {
    assert(picture.pixels.size() == pixel_count(picture.width, picture.height));
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    return encode_with_header({.format = "openexr",
                               .width = picture.width,
                               .height = picture.height,
                               .is_float = true,
                               .pixels = picture.pixels.data()},
                              header);
}

std::string encode_exr(int width, int height, const std::vector<std::string>& channels,
                       const std::function<void(int y, float* values)>& row,
                       const PictureHeader& header) {
    return encode_with_header({.format = "openexr",
                               .width = width,
                               .height = height,
                               .channels = static_cast<int>(channels.size()),
                               .is_float = true,
                               .names = channels,
                               .row = row},
                              header);
}

std::string encode_exr(int width, int height, const std::vector<float>& depth) {
    assert(depth.size() == pixel_count(width, height));
    return encode_image({.format = "openexr",
                         .width = width,
                         .height = height,
                         .channels = 1,
                         .is_float = true,
                         .pixels = depth.data()});
}

std::string encode_png(const Picture& picture, const DisplayTone& tone) {
    return encode_display_image({.format = "png"}, picture, tone);
}

std::string encode_jpeg(const Picture& picture, const DisplayTone& tone, int quality) {
    return encode_display_image({.format = "jpeg", .quality = quality}, picture, tone);
}

}  // namespace lightwalk
