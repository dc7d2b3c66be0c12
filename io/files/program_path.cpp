#include "io/files/program_path.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace lightwalk {

std::string program_path(const std::string& name) {
    const char* const list = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nobody sets it
    std::string_view folders = list != nullptr ? list : "/usr/local/bin:/usr/bin:/bin";
    while (!folders.empty()) {
        const std::size_t end = std::min(folders.find(':'), folders.size());
        const std::filesystem::path program = std::filesystem::path(folders.substr(0, end)) / name;
        folders.remove_prefix(std::min(end + 1, folders.size()));
        std::error_code ignored;
        if (std::filesystem::is_regular_file(program, ignored) &&
            ::access(program.c_str(), X_OK) == 0)
            return program.string();
    }
    return {};
}

}  // namespace lightwalk
