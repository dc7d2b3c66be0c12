// getinfo: headers and sizes of Radiance's files.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>

#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "apps/names/program_words.h"
#include "io/formats/binary_reader.h"
#include "io/formats/header.h"
#include "io/scene/binary_models.h"
#include "io/scene/binary_objects.h"

namespace lightwalk {
namespace {

constexpr const char* kStandardInput = "standard input";

/// The lines of a header with the empty one at its end. Throws InputError for a file without.
std::vector<std::string> read_header_lines(std::istream& file, const std::string& name) {
    constexpr std::size_t kLongest = std::size_t{1} << 20;
    std::vector<std::string> lines;
    std::size_t bytes = 0;
    for (std::string line; std::getline(file, line);) {
        bytes += line.size();
        if (bytes > kLongest) break;
        lines.push_back(line);
        if (line.empty() || line == "\r") return lines;
    }
    throw InputError({name, 0}, "bad header!");
}

std::string format_in(const std::vector<std::string>& lines) {
    std::string format;
    for (const std::string& line : lines)
        if (const auto value = header_variable(line, "FORMAT")) format = *value;
    return format;
}

/// What -d tells of what stands behind a header.
std::string size_text(std::istream& file, const std::vector<std::string>& header,
                      const std::string& name) {
    const std::string format = format_in(header);
    if (format == "Radiance_octree") {
        constexpr std::size_t kEnough = 256;  ///< bytes of the magic number and four numbers
        std::string bytes(kEnough, '\0');
        file.read(bytes.data(), static_cast<std::streamsize>(kEnough));
        bytes.resize(static_cast<std::size_t>(file.gcount()));
        BinaryReader reader(bytes, name, "octree");
        (void)reader.integer(2);
        std::string text;
        for (int i = 0; i < 4; ++i) text += (i > 0 ? " " : "") + reader.string();
        return text;
    }
    std::string line;
    const bool picture = format.starts_with("32-bit_rle_") || format == "Radiance_spectra";
    if (!std::getline(file, line) || !(picture || line.starts_with('-') || line.starts_with('+')))
        return "unknown file type";
    return line;
}

enum class Wanted { header, size, body, more_lines };

/// Copies what is left.
void copy_rest(std::istream& file) {
    std::string block(std::size_t{1} << 16, '\0');
    while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
        write_to_stdout(block.substr(0, static_cast<std::size_t>(file.gcount())));
}

void put_lines(const std::vector<std::string>& lines, const std::string& indent) {
    for (const std::string& line : lines) std::printf("%s%s\n", indent.c_str(), line.c_str());
}

/// The header of standard input with more lines, which replace those of their names where
/// `replaces`, and all that is behind it.
void add_lines(const std::vector<std::string>& added, bool replaces) {
    const auto name_of = [](const std::string& line) { return line.substr(0, line.find('=') + 1); };
    const auto is_replaced = [&](const std::string& line) {
        for (const std::string& other : added)
            if (!name_of(other).empty() && line.starts_with(name_of(other))) return replaces;
        return false;
    };
    const auto is_format = [](const std::string& line) {
        return header_variable(line, "FORMAT").has_value();
    };
    std::vector<std::string> lines = read_header_lines(std::cin, kStandardInput);
    const std::string end = lines.back();
    lines.pop_back();
    std::optional<std::string> format;
    for (const std::string& line : lines) {
        if (is_format(line))
            format = line;
        else if (!is_replaced(line))
            put_lines({line}, "");
    }
    put_lines(added, "");
    if (format) put_lines({*format}, "");
    put_lines({end}, "");
    copy_rest(std::cin);
}

void tell_file(std::istream& file, const std::string& name, Wanted wanted, bool named) {
    const std::vector<std::string> header = read_header_lines(file, name);
    if (wanted == Wanted::size) {
        const std::string text = size_text(file, header, name);
        std::printf("%s%s\n", named ? (name + ": ").c_str() : "", text.c_str());
        return;
    }
    if (named) std::printf("%s:\n", name.c_str());
    put_lines(header, named ? "\t" : "");
}

}  // namespace

int run_getinfo(const std::string& name, const std::vector<std::string>& line,
                Communicator* /*ranks*/) {
    ProgramWords words(line);
    Wanted wanted = Wanted::header;
    bool replaces = false;
    if (words.at_option()) {
        const std::string& option = words.take();
        replaces = option == "-r";
        if (option == "-d")
            wanted = Wanted::size;
        else if (option == "-a" || replaces)
            wanted = Wanted::more_lines;
        else if (option == "-c")
            words.refuse("write the header by getinfo, and the rest by getinfo -");
        else
            words.unknown();
    }
    const std::vector<std::string> files = words.rest();
    if (wanted == Wanted::more_lines) {
        add_lines(files, replaces);
    } else if (wanted == Wanted::header && files == std::vector<std::string>{"-"}) {
        (void)read_header_lines(std::cin, kStandardInput);
        copy_rest(std::cin);
    } else if (files.empty()) {
        tell_file(std::cin, kStandardInput, wanted, false);
    }
    int status = kSuccessStatus;
    for (const std::string& path : files) {
        if (wanted == Wanted::more_lines || path == "-") continue;
        std::fflush(stdout);
        try {
            std::ifstream file(path, std::ios::binary);
            if (!file) throw InputError({path, 0}, "cannot open");
            tell_file(file, path, wanted, true);
        } catch (const InputError& error) {
            std::fprintf(stderr, "%s\n", error.what());
            status = kFailureStatus;
        }
    }
    (void)name;
    if (std::fflush(stdout) != 0) throw InputError("cannot write standard output");
    return status;
}

}  // namespace lightwalk
