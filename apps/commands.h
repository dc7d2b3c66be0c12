#pragma once
// The commands of the program, and what it exits with.
#include <span>
#include <string>
#include <vector>

namespace lightwalk {

class Transport;

inline constexpr int kSuccessStatus = 0;
inline constexpr int kFailureStatus = 1;  ///< bad input, or output that could not be written
inline constexpr int kUsageStatus = 2;    ///< a command line that was not understood

/// Each takes the words after its name and returns the exit status. They throw UsageError and
/// InputError.
/// @param ranks  the wire to the other ranks; null: this process is alone
int run_render(const std::vector<std::string>& words, Transport* ranks);
int run_animate(const std::vector<std::string>& words, Transport* ranks);
int run_walk(const std::vector<std::string>& words, Transport* ranks);
int run_trace(const std::vector<std::string>& words, Transport* ranks);
int run_freeze(const std::vector<std::string>& words, Transport* ranks);
int run_info(const std::vector<std::string>& words, Transport* ranks);

/// Help texts: of the program ("") and of each command.
[[nodiscard]] const char* help_text(const std::string& command);

}  // namespace lightwalk
