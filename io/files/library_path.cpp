#include "io/files/library_path.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/files/large_pages.h"

namespace lightwalk {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

std::string reason(int code) {
    return std::system_category().message(code);
}

/// Reads the rest of a file, of about `expected` and at most `limit` bytes; `name` is for messages.
std::string read_all(std::FILE* file, const std::string& name, std::size_t expected,
                     std::size_t limit) {
    std::string bytes;
    if (expected <= limit) bytes.reserve(expected);
    prefer_large_pages(bytes);
    std::vector<char> chunk(std::size_t{64} << 10);
    std::size_t got = 0;
    while ((got = std::fread(chunk.data(), 1, chunk.size(), file)) > 0) {
        if (got > limit - bytes.size())
            throw InputError({name, 0}, "larger than " + std::to_string(limit) + " bytes");
        bytes.append(chunk.data(), got);
    }
    if (std::ferror(file) != 0) throw InputError({name, 0}, "cannot read: " + reason(errno));
    return bytes;
}

}  // namespace

std::vector<std::string> split_search_path(const std::string& value) {
    std::vector<std::string> elements;
    for (std::size_t begin = 0; begin < value.size();) {
        const std::size_t end = std::min(value.find(':', begin), value.size());
        elements.push_back(end == begin ? "." : value.substr(begin, end - begin));
        begin = end + 1;
    }
    if (elements.empty()) elements.emplace_back(".");
    return elements;
}

std::string path_from(const std::string& directory, const std::string& path) {
    if (directory.empty() || directory == "." || (!path.empty() && path[0] == '/')) return path;
    if (path.empty() || path == ".") return directory;
    return directory.back() == '/' ? directory + path : directory + "/" + path;
}

std::string directory_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return {};
    return slash == 0 ? "/" : path.substr(0, slash);
}

bool is_readable_file(const std::string& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
           access(path.c_str(), R_OK) == 0;
}

LibraryPath::LibraryPath(std::vector<std::string> directories, std::shared_ptr<FileSource> files)
    : directories_(std::move(directories)), given_(directories_), files_(std::move(files)) {}

LibraryPath LibraryPath::from_environment(std::shared_ptr<FileSource> files) {
    std::vector<std::string> directories = split_search_path(files->place("$RAYPATH").value_or(""));
    if (std::optional<std::string> own = files->place("library"))
        directories.push_back(std::move(*own));
    return LibraryPath(std::move(directories), std::move(files));
}

LibraryPath LibraryPath::relative_to(const std::string& directory) const {
    LibraryPath result(given_, files_);
    result.base_ = directory;
    for (std::string& element : result.directories_) element = path_from(directory, element);
    return result;
}

std::optional<std::string> LibraryPath::find(const std::string& name) const {
    if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
    if (std::string path = path_from(base_, name); files_->keeps(path)) return path;
    if (name[0] == '/' || name[0] == '.') {
        const std::string path = path_from(base_, name);
        return files_->readable(path) ? std::optional(path) : std::nullopt;
    }
    if (name[0] == '~') {
        const std::size_t slash = std::min(name.find('/'), name.size());
        const std::optional<std::string> home = files_->place(name.substr(0, slash));
        if (!home || !files_->readable(*home + name.substr(slash))) return std::nullopt;
        return *home + name.substr(slash);
    }
    for (const std::string& directory : directories_) {
        const std::string path = path_from(directory, name);
        if (files_->readable(path)) return path;
    }
    return std::nullopt;
}

std::string LibraryPath::locate(const std::string& name, const std::string& kind) const {
    if (std::optional<std::string> path = find(name)) return *path;
    throw MissingFile("cannot find " + kind + " \"" + name + "\" in " + describe());
}

std::string LibraryPath::describe() const {
    std::string result;
    for (const std::string& directory : directories_) {
        if (!result.empty()) result += ":";
        result += directory;
    }
    return result;
}

std::string read_file(const std::string& path, std::size_t limit) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw InputError({path, 0}, "cannot open: is a directory");
    const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
    if (!file) throw InputError({path, 0}, "cannot open: " + reason(errno));
    const auto size = std::filesystem::file_size(path, error);
    return read_all(file.get(), path, error ? 0 : size, limit);
}

std::string read_standard_input(std::size_t limit) {
    return read_all(stdin, "standard input", 0, limit);
}

}  // namespace lightwalk
