#pragma once
// Decoders of Radiance's data and font files from text in memory. All throw InputError "name: ..."
// or "name:line: ..." for damaged input and bound what they allocate by what the input really
// holds.
#include <string>
#include <string_view>

#include "core/model/resources.h"

namespace lightwalk {

/// Data file (.dat): text table of 1 to 6 dimensions. Coordinates and values are floats; words
/// behind the last value are ignored. See Radiance's ray.pdf, "Data files".
[[nodiscard]] DataArray decode_data(std::string_view text, const std::string& name);
/// Font file (.fnt): glyph numbers, vertex counts and vertices on a grid of 0 to 255.
[[nodiscard]] Font decode_font(std::string_view text, const std::string& name);

}  // namespace lightwalk
