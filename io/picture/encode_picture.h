#pragma once
// Encoders of pictures to the bytes of a file, in memory.
#include <functional>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "io/picture/tone.h"

namespace lightwalk {

/// Quality on JPEG's scale of 1 (smallest file) to 100; at 95 no blocks are visible.
inline constexpr int kJpegQuality = 95;

// All encoders need width times height pixels, and throw InputError "cannot encode FORMAT: ..."
// when OpenImageIO refuses the picture (e.g. one without pixels) or its module is missing. Any
// thread may call them. For .hdr see encode_hdr in picture.h.

/// OpenEXR with float channels R G B [W/(m² sr)] and Radiance's primaries. The lines of `header`
/// become comments, CAPDATE the date.
[[nodiscard]] std::string encode_exr(const Picture& picture, const PictureHeader& header);
/// OpenEXR with named float channels.
/// @param row  fills row y, from the top, with the channels of one pixel after the other
[[nodiscard]] std::string encode_exr(int width, int height,
                                     const std::vector<std::string>& channels,
                                     const std::function<void(int y, float* values)>& row,
                                     const PictureHeader& header);
/// OpenEXR with one float channel Z; `depth` is row by row from the top [m].
[[nodiscard]] std::string encode_exr(int width, int height, const std::vector<float>& depth);
/// PNG with 8-bit sRGB. The tone is an argument, so that parts of one picture can have the same.
[[nodiscard]] std::string encode_png(const Picture& picture, const DisplayTone& tone);
[[nodiscard]] std::string encode_jpeg(const Picture& picture, const DisplayTone& tone,
                                      int quality = kJpegQuality);

}  // namespace lightwalk
