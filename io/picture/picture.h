#pragma once
// Pictures of radiance and their files.
#include <string>
#include <string_view>
#include <vector>

#include "core/math/rgb.h"

namespace lightwalk {

/// Pixels row by row from the top, left to right, in W/(m² sr).
struct Picture {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;
};

/// What a picture's header says beside the pixels; lines as Radiance tools expect them.
struct PictureHeader {
    std::vector<std::string> lines;  ///< history and variables, without #?RADIANCE, FORMAT and resolution
};

/// The bytes of a Radiance picture (.hdr): header, new run-length scanlines, identical to what Radiance writes.
[[nodiscard]] std::string encode_hdr(const Picture& picture, const PictureHeader& header);
/// Read any RGBE/XYZE picture; EXPOSURE and COLORCORR are undone. Throws InputError.
[[nodiscard]] Picture read_hdr(std::string_view bytes, const std::string& name, PictureHeader* header = nullptr);

/// Tone mapping for 8-bit files: `auto` places the log-average at middle grey, or a fixed exposure in EV (stops).
struct ToneMapping {
    bool automatic = true;
    double ev = 0;
};
/// Write by extension: .hdr .pic (Radiance), .exr (float RGB), .png .jpg .jpeg (tone mapped sRGB). The file appears
/// whole or not at all (temporary name, then rename). Throws InputError for other extensions and failed writes.
void write_picture(const std::string& path, const Picture& picture, const PictureHeader& header,
                   const ToneMapping& tone);
/// Depth: `path` ending in .exr: one float channel Z; otherwise raw native floats, row by row from the top.
void write_depth(const std::string& path, int width, int height, const std::vector<float>& depth);
/// Any bytes, whole or not at all.
void write_file_atomically(const std::string& path, std::string_view bytes);

/// Shared-exponent encoding of one pixel, and back. Source: Ward, "Real Pixels", Graphics Gems II (1991).
struct Rgbe {
    unsigned char r = 0, g = 0, b = 0, e = 0;
    friend bool operator==(const Rgbe&, const Rgbe&) = default;
};
[[nodiscard]] Rgbe encode_rgbe(const Rgb& color);
[[nodiscard]] Rgb decode_rgbe(const Rgbe& pixel);

}  // namespace lightwalk
