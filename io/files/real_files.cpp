// The process's own files, environment and standard input.
#include <glob.h>
#include <pwd.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/files/file_source.h"
#include "io/files/library_path.h"
#include "io/files/module.h"

namespace lightwalk {
namespace {

std::optional<std::string> environment(const std::string& name) {
    // setenv is called before there are threads. NOLINTNEXTLINE(concurrency-mt-unsafe)
    const char* const value = std::getenv(name.c_str());
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

/// Home directory of a user, of the caller for ""; nothing for an unknown user.
std::optional<std::string> home_directory(const std::string& user) {
    if (user.empty()) {
        std::optional<std::string> home = environment("HOME");
        if (home && !home->empty()) return home;
    }
    std::vector<char> buffer(16384);
    passwd entry{};
    passwd* found = nullptr;
    if (user.empty()) {
        getpwuid_r(getuid(), &entry, buffer.data(), buffer.size(), &found);
    } else {
        getpwnam_r(user.c_str(), &entry, buffer.data(), buffer.size(), &found);
    }
    if (found == nullptr) return std::nullopt;
    return std::string(entry.pw_dir);
}

/// Where this program's own library files lie, beside the executable, or the library or Python
/// module that this is a part of: prefix/bin, prefix/lib, prefix/lib/x86_64-linux-gnu, or where it
/// was built; nothing when no such folder exists.
std::optional<std::string> own_library() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    std::vector<std::string> candidates;
    for (const std::filesystem::path& folder :
         {std::filesystem::path(own_folder()), program.parent_path()}) {
        if (!folder.is_absolute()) continue;
        for (const std::filesystem::path& prefix :
             {folder.parent_path(), folder.parent_path().parent_path(), folder})
            candidates.push_back((prefix / "share" / "lightwalk" / "lib").string());
    }
    for (std::string& candidate : candidates) {
        if (std::filesystem::is_directory(candidate, error)) return std::move(candidate);
    }
    return std::nullopt;
}

std::optional<std::string> named_place(const std::string& name) {
    if (name.starts_with('$')) return environment(name.substr(1));
    if (name.starts_with('~')) return home_directory(name.substr(1));
    return own_library();
}

std::string read_beginning(const std::string& name, std::size_t limit) {
    std::ifstream file;
    if (name != "-") {
        file.open(name, std::ios::binary);
        if (!file) throw InputError({name, 0}, "cannot open view file");
    }
    std::istream& in = name == "-" ? std::cin : file;
    std::string text;
    for (char c = 0; text.size() < limit && in.get(c);) {
        text += c;
        if (text.ends_with("\n\n") || text.ends_with("\n\r\n")) break;
    }
    return text;
}

std::string input_state() {
    if (isatty(STDIN_FILENO) != 0) return "terminal";
    const int first = std::getc(stdin);
    if (first == EOF) return "empty";
    (void)std::ungetc(first, stdin);
    return "waiting";
}

std::string matches_of(const std::string& pattern) {
    glob_t found{};
    std::string paths;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): a scene is read by one thread
    if (glob(pattern.c_str(), 0, nullptr, &found) == 0) {
        for (std::size_t i = 0; i < found.gl_pathc; ++i)
            paths += std::string(found.gl_pathv[i]) + '\0';
    }
    globfree(&found);
    return paths;
}

/// Nothing when the shell cannot be started; a little more than `limit` bytes when it writes more.
std::optional<std::string> output_of(const std::string& script, std::size_t limit) {
    std::FILE* const pipe = popen(script.c_str(), "r");  // NOLINT(cert-env33-c): only when allowed
    if (pipe == nullptr) return std::nullopt;
    std::string output = "0";
    std::array<char, 65536> chunk{};
    std::size_t got = 0;
    while (output.size() <= limit + 1 &&
           (got = std::fread(chunk.data(), 1, chunk.size(), pipe)) > 0) {
        output.append(chunk.data(), got);
    }
    if (pclose(pipe) != 0) output[0] = '1';
    return output;
}

class RealFiles final : public FileSource {
  public:
    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override {
        switch (question) {
            case Question::readable:
                return is_readable_file(text) ? std::optional<std::string>("1") : std::nullopt;
            case Question::bytes:
                return read_file(text, limit);
            case Question::beginning:
                return read_beginning(text, limit);
            case Question::input:
                return read_standard_input(limit);
            case Question::input_state:
                return input_state();
            case Question::matches:
                return matches_of(text);
            case Question::place:
                return named_place(text);
            case Question::script:
                return output_of(text, limit);
        }
        return std::nullopt;
    }
};

}  // namespace

std::shared_ptr<FileSource> real_files() {
    return std::make_shared<RealFiles>();
}

}  // namespace lightwalk
