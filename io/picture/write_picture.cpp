#include <algorithm>
#include <cassert>
#include <filesystem>
#include <optional>
#include <system_error>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/picture/encode_picture.h"
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

/// The result of `make`; the path is added to the message of its errors.
template <class Make>
std::string encode_for(const std::string& path, const Make& make) {
    try {
        return make();
    } catch (const InputError& error) {
        throw InputError({path, 0}, std::string("cannot write: ") + error.what());
    }
}

enum class PictureFormat { radiance, exr, png, jpeg };

/// Names without an ending, with that of an unfiltered picture (.unf, as of Radiance's rad), with a
/// number as their ending (of a frame), and devices and pipes get what standard output does.
std::optional<PictureFormat> format_of(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == ".hdr" || extension == ".pic" || extension == ".unf" || extension == ".rgbe")
        return PictureFormat::radiance;
    if (extension == ".exr") return PictureFormat::exr;
    if (extension == ".png") return PictureFormat::png;
    if (extension == ".jpg" || extension == ".jpeg") return PictureFormat::jpeg;
    if (extension.find_first_not_of("0123456789", 1) == std::string::npos)
        return PictureFormat::radiance;
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(status) && std::filesystem::is_other(status))
        return PictureFormat::radiance;
    return std::nullopt;
}

PictureFormat known_format_of(const std::string& path) {
    if (const std::optional<PictureFormat> format = format_of(path)) return *format;
    throw InputError({path, 0},
                     "unknown kind of picture \"" + extension_of(path) +
                         "\", expected .hdr .pic .unf .exr .png .jpg .jpeg or no ending");
}

std::string encode(PictureFormat format, const Picture& picture, const PictureHeader& header,
                   const ToneMapping& tone) {
    switch (format) {
        case PictureFormat::exr:
            return encode_exr(picture, header);
        case PictureFormat::png:
            return encode_png(picture, choose_tone(picture, tone));
        case PictureFormat::jpeg:
            return encode_jpeg(picture, choose_tone(picture, tone));
        case PictureFormat::radiance:
            break;
    }
    return encode_hdr(picture, header);
}

}  // namespace

void check_picture_name(const std::string& path) {
    (void)known_format_of(path);
}

bool is_radiance_picture(const std::string& path) {
    return format_of(path) == PictureFormat::radiance;
}

bool is_exr_picture(const std::string& path) {
    return format_of(path) == PictureFormat::exr;
}

void write_picture(const std::string& path, const Picture& picture, const PictureHeader& header,
                   const ToneMapping& tone) {
    const PictureFormat format = known_format_of(path);
    write_file_atomically(path,
                          encode_for(path, [&] { return encode(format, picture, header, tone); }));
}

void write_exr(const std::string& path, const Picture& picture, const std::vector<float>& error,
               const PictureHeader& header) {
    assert(error.size() == picture.pixels.size());
    const auto row = [&](int y, float* to) {
        const auto width = static_cast<std::size_t>(picture.width);
        const std::size_t first = static_cast<std::size_t>(y) * width;
        for (std::size_t i = first; i < first + width; ++i) {
            for (std::size_t k = 0; k < 3; ++k) *to++ = picture.pixels[i][k];
            *to++ = error[i];
        }
    };
    write_file_atomically(
        path, encode_for(path, [&] {
            return encode_exr(picture.width, picture.height, {"R", "G", "B", "error"}, row, header);
        }));
}

void write_depth(const std::string& path, int width, int height, const std::vector<float>& depth) {
    assert(depth.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    if (extension_of(path) == ".exr") {
        write_file_atomically(path,
                              encode_for(path, [&] { return encode_exr(width, height, depth); }));
        return;
    }
    write_file_atomically(
        path, {reinterpret_cast<const char*>(depth.data()), depth.size() * sizeof(float)});
}

}  // namespace lightwalk
