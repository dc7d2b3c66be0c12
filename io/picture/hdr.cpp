#include <array>
#include <cassert>
#include <cstdio>

#include "core/error.h"
#include "core/math/xyz.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"
#include "io/picture/picture.h"
#include "io/picture/rgbe_picture.h"
#include "io/picture/scanline.h"

namespace lightwalk {
namespace {

/// One of the three factors of the COLORCORR lines.
double color_correction(const InfoHeader& header, std::size_t channel, const std::string& name) {
    double product = 1;
    for (const std::string& line : header.lines) {
        std::optional<std::string_view> value = header_variable(line, "COLORCORR");
        if (!value) continue;
        std::string_view word;
        for (std::size_t k = 0; k <= channel; ++k) word = take_word(*value);
        double factor = 0;
        if (!parse_real(word, factor) || !(factor > 0)) {
            throw InputError({name, 0}, "bad picture file: COLORCORR needs three positive numbers");
        }
        product *= factor;
    }
    return product;
}

/// History and variables that still hold once exposure is undone.
std::vector<std::string> remaining_lines(const InfoHeader& header) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < header.lines.size(); ++i) {
        const std::string& line = header.lines[i];
        const bool undone = header_variable(line, "EXPOSURE") || header_variable(line, "COLORCORR");
        if (!undone && !(i == 0 && line.starts_with("#?"))) lines.push_back(line);
    }
    return lines;
}

/// A header line as it may stand in a file, without line ends inside.
std::string clean_line(std::string line) {
    for (char& c : line) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    return line;
}

}  // namespace

std::string encode_hdr(const Picture& picture, const PictureHeader& header) {
    const auto width = static_cast<std::size_t>(picture.width),
               height = static_cast<std::size_t>(picture.height);
    assert(picture.pixels.size() == width * height);
    std::string bytes = "#?RADIANCE\n";
    for (const std::string& line : header.lines) {
        if (line.empty() || header_variable(line, "FORMAT")) continue;
        bytes += clean_line(line) + '\n';
    }
    std::array<char, 64> resolution{};
    (void)std::snprintf(resolution.data(), resolution.size(), "-Y %8d +X %8d\n", picture.height,
                        picture.width);
    bytes += header.xyz ? "FORMAT=32-bit_rle_xyze\n\n" : "FORMAT=32-bit_rle_rgbe\n\n";
    bytes += resolution.data();
    bytes.reserve(bytes.size() + picture.pixels.size() * sizeof(Rgbe));
    std::vector<Rgbe> scanline(width);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const Rgb& pixel = picture.pixels[y * width + x];
            scanline[x] = encode_rgbe(header.xyz ? to_xyz(pixel) : pixel);
        }
        encode_scanline(scanline, bytes);
    }
    return bytes;
}

Picture read_hdr(std::string_view bytes, const std::string& name, PictureHeader* header) {
    const RgbePicture stored = decode_rgbe_picture(bytes, name, XyzPictures::accept);
    const InfoHeader& info = stored.header;
    const bool xyz = info.format == "32-bit_rle_xyze";
    const double exposure = header_product(info, "EXPOSURE", name);
    Rgb undo;
    for (std::size_t k = 0; k < 3; ++k) {
        undo[k] = static_cast<float>(1 / (exposure * color_correction(info, k, name)));
    }
    Picture picture{stored.width, stored.height, {}};
    picture.pixels.reserve(stored.pixels.size());
    for (const Rgbe& pixel : stored.pixels) {
        const Rgb color = decode_rgbe(pixel) * undo;
        picture.pixels.push_back(xyz ? from_xyz(color) : color);
    }
    if (header != nullptr) header->lines = remaining_lines(info);
    return picture;
}

}  // namespace lightwalk
