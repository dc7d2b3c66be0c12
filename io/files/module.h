#pragma once
// Modules: shared libraries of the program that are loaded only when they are needed.
#include <string>

namespace lightwalk {

/// The address of `symbol` in the module `file` ("liblightwalk_x.so"). It is searched for beside
/// the program, or the Python module that this code is a part of, in the installation's lib folder
/// and where it was built, and stays loaded until the process ends. On failure the result is null
/// and `error` is the reason.
[[nodiscard]] void* load_from_module(const char* file, const char* symbol, std::string& error);
/// Of the program or the shared library that this code is a part of, as it was loaded; "": not
/// known.
[[nodiscard]] std::string own_folder();
/// Why this thread's last dlopen() or dlsym() has failed.
[[nodiscard]] std::string loading_error();

}  // namespace lightwalk
