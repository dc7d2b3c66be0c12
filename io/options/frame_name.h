#pragma once
// Names of the files of a picture sequence.
#include <string>

namespace lightwalk {

/// The name of frame `number`: `pattern` with its one integer conversion (%d, %03d, ...) filled in;
/// %% is a percent sign. A pattern without conversion stands for itself. Throws UsageError for any
/// other conversion, for a second one, and for a width above 99.
[[nodiscard]] std::string frame_name(const std::string& pattern, int number);

/// Whether the names of different frames differ.
[[nodiscard]] bool varies_by_frame(const std::string& pattern);

}  // namespace lightwalk
