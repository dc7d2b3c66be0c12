#pragma once
// Modules: shared libraries of the program that are loaded only when they are needed.
#include <string>

namespace lightwalk {

/// The address of `symbol` in the module `file` ("liblightwalk_x.so"). It is searched for beside
/// the program, in the installation's lib folder and where it was built, and stays loaded until the
/// process ends. On failure the result is null and `error` is the reason.
[[nodiscard]] void* load_from_module(const char* file, const char* symbol, std::string& error);
/// Why this thread's last dlopen() or dlsym() has failed.
[[nodiscard]] std::string loading_error();

}  // namespace lightwalk
