#include "io/picture/rgbe_picture.h"

#include <cmath>

#include "core/error.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"
#include "io/picture/resolution_line.h"
#include "io/picture/scanline.h"

namespace lightwalk {
namespace {

constexpr std::uint64_t kPixelsAlwaysAllowed = 1 << 24, kPixelsPerByte = 64;

/// Scanlines in stored order. A scanline has at least four bytes.
std::vector<Rgbe> take_scanlines(std::string_view bytes, const PictureResolution& resolution,
                                 const std::string& name) {
    const auto scanlines = static_cast<std::size_t>(resolution.scanlines());
    const auto length = static_cast<std::size_t>(resolution.length());
    if (scanlines > bytes.size() / 4) {
        throw bad_picture(name, "the data end before scanline " +
                                    std::to_string(bytes.size() / 4 + 1) + " of " +
                                    std::to_string(scanlines));
    }
    if (length > (kPixelsAlwaysAllowed + kPixelsPerByte * bytes.size()) / scanlines) {
        throw bad_picture(name, std::to_string(resolution.width) + " x " +
                                    std::to_string(resolution.height) +
                                    " pixels are too many for a file of its size");
    }
    std::vector<Rgbe> pixels;
    for (std::size_t j = 0; j < scanlines; ++j) {
        pixels.resize(pixels.size() + length);
        try {
            decode_scanline(bytes, std::span(pixels).subspan(j * length));
        } catch (const InputError& error) {
            throw bad_picture(name, "scanline " + std::to_string(j + 1) + ": " + error.what());
        }
    }
    return pixels;
}

/// From stored order to rows from the top.
std::vector<Rgbe> upright(std::vector<Rgbe> stored, const PictureResolution& resolution) {
    if (resolution.standard()) return stored;
    std::vector<Rgbe> pixels(stored.size());
    const auto width = static_cast<std::size_t>(resolution.width),
               height = static_cast<std::size_t>(resolution.height);
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t column = 0; column < width; ++column) {
            pixels[row * width + column] = stored[resolution.stored_index(row, column)];
        }
    }
    return pixels;
}

}  // namespace

RgbePicture decode_rgbe_picture(std::string_view bytes, const std::string& name, XyzPictures xyz) {
    RgbePicture picture;
    picture.header = decode_header(bytes, name);
    const std::string& format = picture.header.format;
    const bool accepted = format.empty() || format == "32-bit_rle_rgbe" ||
                          (xyz == XyzPictures::accept && format == "32-bit_rle_xyze");
    if (!accepted) throw bad_picture(name, "format \"" + format + "\", expected 32-bit_rle_rgbe");
    bytes.remove_prefix(picture.header.size);
    const PictureResolution resolution = take_resolution(bytes, name);
    picture.width = resolution.width;
    picture.height = resolution.height;
    picture.pixels = upright(take_scanlines(bytes, resolution, name), resolution);
    return picture;
}

double header_product(const InfoHeader& header, std::string_view variable,
                      const std::string& name) {
    double product = 1;
    for (const std::string& line : header.lines) {
        std::optional<std::string_view> value = header_variable(line, variable);
        if (!value) continue;
        double factor = 0;
        if (parse_real(take_word(*value), factor))
            product *= factor;
        else
            product = 0;
        if (!(product > 0 && std::isfinite(product))) {
            throw bad_picture(
                name, "header line \"" + line.substr(0, 80) + "\", expected a positive number");
        }
    }
    return product;
}

double pixel_aspect(const InfoHeader& header, const std::string& name) {
    const double aspect = header_product(header, "PIXASPECT", name);
    if (aspect <= 1e-6) throw bad_picture(name, "the pixel aspect is zero");
    return aspect;
}

}  // namespace lightwalk
