#pragma once
// Header lines that say how a result came about.
#include <string>
#include <vector>

namespace lightwalk {

/// The header lines of a result: the scene's own, the command's, SOFTWARE=.
[[nodiscard]] std::vector<std::string> history_header(const std::vector<std::string>& scene_header,
                                                      const std::string& command_line);
/// CAPDATE= and GMT= of now.
[[nodiscard]] std::vector<std::string> date_lines();

}  // namespace lightwalk
