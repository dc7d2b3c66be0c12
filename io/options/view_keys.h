#pragma once
// Files of views that a walk passes through.
#include <string>
#include <string_view>
#include <vector>

#include "core/view/view_path.h"

namespace lightwalk {

/// The keys of a path file: one view a line, as in view files (VIEW= or the name of a program that
/// takes views, then view options; what a line does not mention it takes from the one before).
/// Before it a line may tell its time [s]; otherwise a key comes one second after the last, the
/// first at 0. Empty lines and those that begin with # do not count.
/// @param name  of the file, for messages
/// @param view  what the first line starts from
/// Throws InputError with the line's number for any other line, for a view that is none, for times
/// that do not rise, a second type of view, and for a file without views.
[[nodiscard]] std::vector<ViewKey> read_view_keys(std::string_view text, const std::string& name,
                                                  View view);

}  // namespace lightwalk
