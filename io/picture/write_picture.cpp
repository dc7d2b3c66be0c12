#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <filesystem>

#include "core/error.h"
#include "io/formats/decode.h"
#include "io/picture/picture.h"

namespace lightwalk {
namespace {

constexpr int kJpegQuality = 95;

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

/// The bytes of an image file, made in memory so that it can be written whole.
/// @param format  OpenImageIO's name of the format
/// @param pixels  of the type that `spec` says
std::vector<unsigned char> encode_image(const std::string& path, const std::string& format,
                                        const OIIO::ImageSpec& spec, const void* pixels) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output) throw InputError({path, 0}, "cannot write: " + OIIO::geterror());
    const bool written = output->set_ioproxy(&memory) && output->open(format, spec) &&
                         output->write_image(spec.format, pixels) && output->close();
    if (!written) throw InputError({path, 0}, "cannot write: " + output->geterror());
    return bytes;
}

void write_exr(const std::string& path, const Picture& picture, const PictureHeader& header) {
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeFloat);
    constexpr std::array<float, 8> kPrimaries{0.64f, 0.33f, 0.29f,    0.6f,
                                              0.15f, 0.06f, 1 / 3.0f, 1 / 3.0f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kPrimaries.data());
    std::string history;
    for (const std::string& line : header.lines) {
        history += line + '\n';
        if (const auto date = header_variable(line, "CAPDATE")) {
            spec.attribute("DateTime", std::string(*date));  // else OpenImageIO writes its own
        }
    }
    spec.attribute("comments", history);
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    write_file_atomically(path,
                          characters(encode_image(path, "openexr", spec, picture.pixels.data())));
}

void write_display_image(const std::string& path, const std::string& format, const Picture& picture,
                         const ToneMapping& tone) {
    const double scale = display_scale(picture, tone);
    std::vector<std::array<std::uint8_t, 3>> pixels(picture.pixels.size());
    std::transform(picture.pixels.begin(), picture.pixels.end(), pixels.begin(),
                   [&](const Rgb& color) { return display_pixel(color, scale); });
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (format == "jpeg") spec.attribute("CompressionQuality", kJpegQuality);
    write_file_atomically(path, characters(encode_image(path, format, spec, pixels.data())));
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
    OIIO::ImageSpec spec(width, height, 1, OIIO::TypeFloat);
    spec.channelnames = {"Z"};
    spec.z_channel = 0;
    write_file_atomically(path, characters(encode_image(path, "openexr", spec, depth.data())));
}

}  // namespace lightwalk
