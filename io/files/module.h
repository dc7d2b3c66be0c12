#pragma once
// Parts of the program that are loaded only where they are needed.
#include <string>

namespace lightwalk {

/// The address of `symbol` in the module `file` ("liblightwalk_x.so"), which is looked for beside
/// the program, in the installation's lib folder and where it was built, and stays loaded until the
/// process ends. Null and the reason in `error` where that fails.
[[nodiscard]] void* load_from_module(const char* file, const char* symbol, std::string& error);

}  // namespace lightwalk
