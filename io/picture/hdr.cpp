#include <array>
#include <cassert>
#include <cstdio>

#include "core/error.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"
#include "io/picture/picture.h"
#include "io/picture/rgbe_picture.h"
#include "io/picture/scanline.h"

namespace lightwalk {
namespace {

constexpr double kLumensPerWatt = 179;  // Radiance's luminous efficacy of equal-energy white

/// CIE XYZ to Radiance's primaries (R .640 .330, G .290 .600, B .150 .060, white 1/3 1/3).
constexpr std::array<std::array<double, 3>, 3> kFromXyz{{{2.565312843, -1.166849616, -0.398463227},
                                                         {-1.022108172, 1.978286617, 0.043821555},
                                                         {0.074724377, -0.251939567, 1.177215190}}};

/// Photometric XYZ [cd/m² for Y] to radiance.
Rgb from_xyz(const Rgb& xyz) {
    const auto X = static_cast<double>(xyz.r), Y = static_cast<double>(xyz.g),
               Z = static_cast<double>(xyz.b);
    Rgb color;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::array<double, 3>& row = kFromXyz[i];
        color[i] = static_cast<float>((row[0] * X + row[1] * Y + row[2] * Z) / kLumensPerWatt);
    }
    return color;
}

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
    bytes += "FORMAT=32-bit_rle_rgbe\n\n";
    bytes += resolution.data();
    std::vector<Rgbe> scanline(width);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x)
            scanline[x] = encode_rgbe(picture.pixels[y * width + x]);
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
