#pragma once
// Views as text: options, view strings, view files and walk-through paths. See Radiance's manual
// pages rpict(1) and rvu(1), "-v...".
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/view/view.h"
#include "io/files/file_source.h"

namespace lightwalk {

/// The view as options: type, point, direction, up, sizes, clipping, shift and lift; point and
/// direction with 7 significant digits, the rest with 5. "VIEW= " before it makes a header line.
[[nodiscard]] std::string view_text(const View& view);

/// Apply the view option at the front of `words` with its arguments: -vt -vp -vd -vu -vh -vv -vo
/// -va -vs -vl, and -vf FILE, which reads a view file by its name as it stands ("-": standard
/// input). What the option doesn't mention keeps its value; whether the view makes sense is
/// Camera's question.
/// @return words used, 0 when the first word is not a view option
/// Throws InputError when arguments are missing or malformed, or as read_view_file().
std::size_t parse_view_option(std::span<const std::string> words, View& view,
                              FileSource& files = *real_files());

/// Apply the view options within a text; anything else in it, malformed options and -vf are
/// skipped.
/// @return how many options were applied
int parse_view_string(std::string_view text, View& view);

/// Apply the view lines of a view file, a picture or a list of rvu lines, in order, up to the first
/// empty line: those that begin with VIEW= or the name of a program that takes views. Later lines
/// override earlier ones parameter by parameter. Throws InputError `bad view file` when there is
/// none with a view option.
void read_view_file(std::string_view text, const std::string& name, View& view);

/// The frames of a walk-through: one for every view line of the text, each starting from the view
/// before it.
[[nodiscard]] std::vector<View> read_view_sequence(std::string_view text, View view);

}  // namespace lightwalk
