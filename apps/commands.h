#pragma once
// The commands of the program, and what it exits with.
#include <span>
#include <string>
#include <vector>

namespace lightwalk {

inline constexpr int kSuccessStatus = 0;
inline constexpr int kFailureStatus = 1;  ///< bad input, or output that could not be written
inline constexpr int kUsageStatus = 2;    ///< a command line that was not understood

/// Each takes the words after its name and returns the exit status. They throw UsageError and
/// InputError.
int run_render(const std::vector<std::string>& words);
int run_trace(const std::vector<std::string>& words);
int run_info(const std::vector<std::string>& words);

/// Help texts: of the program ("") and of each command.
[[nodiscard]] const char* help_text(const std::string& command);

}  // namespace lightwalk
