#pragma once
// Decodes Radiance pictures to the pixels as they are stored.
#include <string>
#include <string_view>
#include <vector>

#include "core/math/rgbe.h"
#include "io/formats/header.h"

namespace lightwalk {

struct RgbePicture {
    InfoHeader header;
    int width = 0, height = 0;
    /// Row by row from the top, left to right, for any orientation of the file.
    std::vector<Rgbe> pixels;
};

enum class XyzPictures { refuse, accept };

/// Decode header, resolution line and scanlines. FORMAT must be 32-bit_rle_rgbe, or 32-bit_rle_xyze
/// where that is accepted, or absent. At most 64 pixels for each byte of the file plus 16 million
/// are allocated. Throws InputError.
[[nodiscard]] RgbePicture decode_rgbe_picture(std::string_view bytes, const std::string& name,
                                              XyzPictures xyz);

/// The product of the numbers in the header lines "name=number"; 1 without such a line. Throws
/// InputError for a value that is no positive number.
[[nodiscard]] double header_product(const InfoHeader& header, std::string_view variable,
                                    const std::string& name);

/// The product of the PIXASPECT lines: pixel height / pixel width.
[[nodiscard]] double pixel_aspect(const InfoHeader& header, const std::string& name);

}  // namespace lightwalk
