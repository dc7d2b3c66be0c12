#include <algorithm>
#include <cassert>
#include <filesystem>

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

/// The result of `encode`; the path is added to the message of its errors.
template <class Encode>
std::string encode_for(const std::string& path, const Encode& encode) {
    try {
        return encode();
    } catch (const InputError& error) {
        throw InputError({path, 0}, std::string("cannot write: ") + error.what());
    }
}

std::string encode_by_extension(const std::string& extension, const Picture& picture,
                                const PictureHeader& header, const ToneMapping& tone) {
    if (extension == ".exr") return encode_exr(picture, header);
    if (extension == ".png") return encode_png(picture, choose_tone(picture, tone));
    if (extension == ".jpg" || extension == ".jpeg")
        return encode_jpeg(picture, choose_tone(picture, tone));
    return encode_hdr(picture, header);
}

}  // namespace

bool is_radiance_picture(const std::string& path) {
    const std::string extension = extension_of(path);
    return extension == ".hdr" || extension == ".pic";
}

void write_picture(const std::string& path, const Picture& picture, const PictureHeader& header,
                   const ToneMapping& tone) {
    const std::string extension = extension_of(path);
    for (const char* known : {".hdr", ".pic", ".exr", ".png", ".jpg", ".jpeg"}) {
        if (extension != known) continue;
        const auto encode = [&] { return encode_by_extension(extension, picture, header, tone); };
        write_file_atomically(path, encode_for(path, encode));
        return;
    }
    throw InputError({path, 0}, "unknown kind of picture \"" + extension +
                                    "\", expected .hdr .pic .exr .png .jpg or .jpeg");
}

void write_depth(const std::string& path, int width, int height, const std::vector<float>& depth) {
    assert(depth.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    if (extension_of(path) == ".exr") {
        const auto encode = [&] { return encode_exr(width, height, depth); };
        write_file_atomically(path, encode_for(path, encode));
        return;
    }
    write_file_atomically(
        path, {reinterpret_cast<const char*>(depth.data()), depth.size() * sizeof(float)});
}

}  // namespace lightwalk
