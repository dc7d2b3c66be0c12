#pragma once
// Decoders of Radiance's data formats from bytes in memory. All throw InputError "name: ..." or
// "name:line: ..." for damaged input and bound what they allocate by what the input really holds.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/resources.h"

namespace lightwalk {

/// Data file (.dat): text table of 1 to 6 dimensions. Coordinates and values are floats; words
/// behind the last value are ignored. See Radiance's ray.pdf, "Data files".
[[nodiscard]] DataArray decode_data(std::string_view text, const std::string& name);
/// Font file (.fnt): glyph numbers, vertex counts and vertices on a grid of 0 to 255.
[[nodiscard]] Font decode_font(std::string_view text, const std::string& name);
/// RGBE picture (any orientation, flat, old or new run-length form) as a table whose shorter side
/// has length 1; PIXASPECT is heeded, EXPOSURE and COLORCORR are not; other formats are refused.
[[nodiscard]] PictureData decode_picture(std::string_view bytes, const std::string& name);

/// An information header: its lines, the value of FORMAT= ("" when absent), and where the data
/// begin.
struct InfoHeader {
    std::vector<std::string> lines;  ///< without FORMAT
    std::string format;
    std::size_t size = 0;  ///< bytes, with the empty line
};
/// At most 1 MiB; throws InputError when `bytes` does not begin with a header.
[[nodiscard]] InfoHeader decode_header(std::string_view bytes, const std::string& name);
/// Value of a header line "name=value", without blanks around it; nothing when the line is another
/// one.
[[nodiscard]] std::optional<std::string_view> header_variable(std::string_view line,
                                                              std::string_view name);

}  // namespace lightwalk
