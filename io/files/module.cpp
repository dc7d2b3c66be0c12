#include "io/files/module.h"

#include <dlfcn.h>

#include <filesystem>

namespace lightwalk {

std::string own_folder() {
    Dl_info found{};
    if (dladdr(reinterpret_cast<const void*>(&load_from_module), &found) == 0) return {};
    return std::filesystem::path(found.dli_fname).parent_path().string();
}

std::string loading_error() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): glibc keeps the text by thread.
    const char* text = dlerror();
    return text != nullptr ? text : "unknown error";
}

void* load_from_module(const char* file, const char* symbol, std::string& error) {
    std::error_code failed;
    const std::filesystem::path here =
        std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
    const std::filesystem::path own = own_folder();
    // Beside the program, as built or in a wheel; installed; beside a library or a Python module;
    // beside the program of which this is a test.
    for (const std::filesystem::path& folder :
         {here, here / ".." / LIGHTWALK_LIBDIR / "lightwalk", own / "lightwalk",
          own.is_absolute() ? own : here, here / ".."}) {
        void* module = dlopen((folder / file).c_str(), RTLD_NOW | RTLD_LOCAL);
        if (module == nullptr) {
            error = loading_error();
            continue;
        }
        void* found = dlsym(module, symbol);
        if (found == nullptr) error = loading_error();
        return found;
    }
    return nullptr;
}

}  // namespace lightwalk
