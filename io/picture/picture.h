#pragma once
// Pictures of radiance and their files.
#include <string>
#include <string_view>
#include <vector>

#include "core/math/rgb.h"

namespace lightwalk {

struct ToneMapping;  // io/picture/tone.h

/// Pixels row by row from the top, left to right, in W/(m² sr).
struct Picture {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;
};

/// What a picture's header says beside the pixels; lines as Radiance tools expect them (see
/// picture_header.h).
struct PictureHeader {
    /// History and variables, without #?RADIANCE, FORMAT and resolution.
    std::vector<std::string> lines;
    bool xyz = false;  ///< pixels are stored as CIE XYZ, Y in cd/m² (FORMAT=32-bit_rle_xyze)
};

/// The bytes of a Radiance picture (.hdr): header, new run-length scanlines, identical to what
/// Radiance writes. The picture is radiance also where `header` asks for XYZ.
[[nodiscard]] std::string encode_hdr(const Picture& picture, const PictureHeader& header);
/// Read any RGBE/XYZE picture; EXPOSURE and COLORCORR are undone and left out of `header`. Throws
/// InputError.
[[nodiscard]] Picture read_hdr(std::string_view bytes, const std::string& name,
                               PictureHeader* header = nullptr);

/// Write by extension: .hdr .pic (Radiance), .exr (float RGB), .png .jpg .jpeg (sRGB, see tone.h).
/// The file appears whole or not at all (temporary name, then rename). Throws InputError for other
/// extensions and failed writes, naming the path.
void write_picture(const std::string& path, const Picture& picture, const PictureHeader& header,
                   const ToneMapping& tone);
/// Whether write_picture makes a Radiance picture of this name.
[[nodiscard]] bool is_radiance_picture(const std::string& path);
/// Depth: `path` ending in .exr: one float channel Z; otherwise raw native floats, row by row from
/// the top.
void write_depth(const std::string& path, int width, int height, const std::vector<float>& depth);

}  // namespace lightwalk
