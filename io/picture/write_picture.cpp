#include <algorithm>
#include <array>
#include <cassert>
#include <filesystem>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/formats/header.h"
#include "io/picture/image_encoder.h"
#include "io/picture/picture.h"
#include "io/picture/tone.h"

namespace lightwalk {
namespace {

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    });
    return extension;
}

std::string_view characters(const std::vector<unsigned char>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write_exr(const std::string& path, const Picture& picture, const PictureHeader& header) {
    std::string history, date;
    for (const std::string& line : header.lines) {
        history += line + '\n';
        if (const auto taken = header_variable(line, "CAPDATE")) date = *taken;
    }
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    const ImageRequest request{"openexr", picture.width,         picture.height,  3,
                               true,      picture.pixels.data(), history.c_str(), date.c_str()};
    write_file_atomically(path, characters(encode_image(path, request)));
}

void write_display_image(const std::string& path, const char* format, const Picture& picture,
                         const ToneMapping& tone) {
    const DisplayTone settled = settle_tone(picture, tone);
    std::vector<std::array<std::uint8_t, 3>> pixels(picture.pixels.size());
    std::transform(picture.pixels.begin(), picture.pixels.end(), pixels.begin(),
                   [&](const Rgb& color) { return display_pixel(color, settled); });
    const ImageRequest request{format, picture.width, picture.height, 3, false, pixels.data(), "",
                               ""};
    write_file_atomically(path, characters(encode_image(path, request)));
}

}  // namespace

void write_picture(const std::string& path, const Picture& picture, const PictureHeader& header,
                   const ToneMapping& tone) {
    const std::string extension = extension_of(path);
    if (extension == ".hdr" || extension == ".pic") {
        write_file_atomically(path, encode_hdr(picture, header));
    } else if (extension == ".exr") {
        write_exr(path, picture, header);
    } else if (extension == ".png") {
        write_display_image(path, "png", picture, tone);
    } else if (extension == ".jpg" || extension == ".jpeg") {
        write_display_image(path, "jpeg", picture, tone);
    } else {
        throw InputError({path, 0}, "unknown kind of picture \"" + extension +
                                        "\", expected .hdr .pic .exr .png .jpg or .jpeg");
    }
}

void write_depth(const std::string& path, int width, int height, const std::vector<float>& depth) {
    assert(depth.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    if (extension_of(path) != ".exr") {
        write_file_atomically(
            path, {reinterpret_cast<const char*>(depth.data()), depth.size() * sizeof(float)});
        return;
    }
    const ImageRequest request{"openexr", width, height, 1, true, depth.data(), "", ""};
    write_file_atomically(path, characters(encode_image(path, request)));
}

}  // namespace lightwalk
