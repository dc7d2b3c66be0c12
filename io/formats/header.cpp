#include "io/formats/header.h"

#include <algorithm>

#include "core/error.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLargestHeader = 1 << 20;
constexpr std::size_t kLongestFormat = 63;

}  // namespace

std::optional<std::string_view> header_variable(std::string_view line, std::string_view name) {
    if (!line.starts_with(name) || line.substr(name.size(), 1) != "=") return std::nullopt;
    line.remove_prefix(name.size() + 1);
    const std::size_t first = std::min(line.find_first_not_of(" \t\r\n\v\f"), line.size());
    const std::size_t last = line.find_last_not_of(" \t\r\n\v\f");
    return last == std::string_view::npos ? std::string_view()
                                          : line.substr(first, last + 1 - first);
}

InfoHeader decode_header(std::string_view bytes, const std::string& name) {
    if (bytes.empty() || bytes.front() < ' ' || bytes.front() > '~') {
        throw InputError({name, 0}, "no information header");
    }
    InfoHeader header;
    std::string_view rest = bytes.substr(0, kLargestHeader);
    while (!rest.empty()) {
        const bool whole = rest.find('\n') != std::string_view::npos;
        const std::string_view line = take_line(rest);
        if (!whole) break;
        header.size = static_cast<std::size_t>(rest.data() - bytes.data());
        if (line.empty()) return header;
        if (const std::optional<std::string_view> format = header_variable(line, "FORMAT")) {
            header.format = format->substr(0, kLongestFormat);
        } else {
            header.lines.emplace_back(line);
        }
    }
    throw InputError({name, 0}, bytes.size() < kLargestHeader
                                    ? "the information header has no end, expected an empty line"
                                    : "the information header is longer than 1 MiB");
}

}  // namespace lightwalk
