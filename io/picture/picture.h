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

/// The header of a picture; its lines are in the form that Radiance's tools expect (see
/// picture_header.h).
struct PictureHeader {
    /// The lines of history and variables, without #?RADIANCE, FORMAT and resolution.
    std::vector<std::string> lines;
    bool xyz = false;  ///< pixels are stored as CIE XYZ, Y in cd/m² (FORMAT=32-bit_rle_xyze)
};

/// Encode a Radiance picture (.hdr) with scanlines in the new run-length form; the bytes are
/// identical to those of Radiance. `picture` is radiance, also when `header` asks for XYZ.
[[nodiscard]] std::string encode_hdr(const Picture& picture, const PictureHeader& header);
/// Decode an RGBE or XYZE picture. EXPOSURE and COLORCORR are undone, and left out of `header`.
/// Throws InputError.
[[nodiscard]] Picture read_hdr(std::string_view bytes, const std::string& name,
                               PictureHeader* header = nullptr);

/// Write a picture in the format of the extension: .hdr .pic .unf (Radiance), .exr (float RGB),
/// .png .jpg .jpeg (sRGB, see tone.h). Names without one, or with a number in its place, devices
/// and pipes get a Radiance picture. The file is written atomically. Throws InputError with the
/// path for other extensions and failed writes.
void write_picture(const std::string& path, const Picture& picture, const PictureHeader& header,
                   const ToneMapping& tone);
/// The same of an .exr with one more channel, called "error".
/// @param error  of each pixel, as many as there are
void write_exr(const std::string& path, const Picture& picture, const std::vector<float>& error,
               const PictureHeader& header);
/// Throws the InputError of write_picture for a path whose extension promises another format.
void check_picture_name(const std::string& path);
/// Whether write_picture writes a Radiance picture for this name.
[[nodiscard]] bool is_radiance_picture(const std::string& path);
/// Whether write_picture writes an OpenEXR file for this name.
[[nodiscard]] bool is_exr_picture(const std::string& path);
/// Write depths: for a `path` that ends in .exr as one float channel Z, otherwise as raw native
/// floats, row by row from the top.
void write_depth(const std::string& path, int width, int height, const std::vector<float>& depth);

}  // namespace lightwalk
