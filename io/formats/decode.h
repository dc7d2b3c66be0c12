#pragma once
// Decoders of Radiance's data and font files, from text in memory. They throw InputError "name:
// ..." or "name:line: ..." for damaged input, and allocate no more than the size of the input
// justifies.
#include <string>
#include <string_view>

#include "core/model/resources.h"

namespace lightwalk {

/// Decode a data file (.dat): a table of 1 to 6 dimensions as text. Coordinates and values are
/// rounded to float; words after the last value are ignored. See Radiance's ray.pdf, "Data files".
[[nodiscard]] DataArray decode_data(std::string_view text, const std::string& name);
/// Decode a font file (.fnt): numbers of glyphs, their vertex counts, and vertices on a grid of 0
/// to 255.
[[nodiscard]] Font decode_font(std::string_view text, const std::string& name);

}  // namespace lightwalk
