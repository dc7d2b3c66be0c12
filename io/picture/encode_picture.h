#pragma once
// Pictures as the bytes of a file, in memory: for files, and for viewers that get them over a wire.
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "io/picture/tone.h"

namespace lightwalk {

/// JPEG's scale of 1 (smallest) to 100; 95 shows no blocks.
inline constexpr int kJpegQuality = 95;

// All take pictures with one pixel a place, width times height of them, and throw InputError
// "cannot encode FORMAT: ..." where OpenImageIO refuses (a picture without pixels) or its module is
// missing. Any thread may call them. For .hdr see encode_hdr in picture.h.

/// OpenEXR: float R G B [W/(m² sr)] with Radiance's primaries; the header's lines as comments,
/// CAPDATE as the date.
[[nodiscard]] std::string encode_exr(const Picture& picture, const PictureHeader& header);
/// OpenEXR: one float channel Z; `depth` is row by row from the top.
[[nodiscard]] std::string encode_exr(int width, int height, const std::vector<float>& depth);
/// 8-bit sRGB. The tone is settled already: the parts of one picture are shown with one.
[[nodiscard]] std::string encode_png(const Picture& picture, const DisplayTone& tone);
[[nodiscard]] std::string encode_jpeg(const Picture& picture, const DisplayTone& tone,
                                      int quality = kJpegQuality);

}  // namespace lightwalk
