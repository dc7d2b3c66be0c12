#pragma once
// Where other programs are.
#include <string>

namespace lightwalk {

/// The path of a program that is looked for along PATH; "": it is not installed. Reads the
/// environment, which nobody may write meanwhile.
[[nodiscard]] std::string program_path(const std::string& name);

}  // namespace lightwalk
