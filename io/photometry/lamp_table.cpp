#include "io/photometry/lamp_table.h"

#include <regex.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/error.h"
#include "core/model/transform_args.h"
#include "core/spectrum/spectrum_color.h"
#include "io/formats/words.h"

namespace lightwalk {

struct FreeRegex {
    void operator()(regex_t* compiled) const noexcept {
        regfree(compiled);
        delete compiled;  // NOLINT(cppcoreguidelines-owning-memory): the deleter of a pointer
    }
};
using Regex = std::unique_ptr<regex_t, FreeRegex>;

namespace {

constexpr std::size_t kLongestPattern = 127;
constexpr std::size_t kLongestLine = 1023;  ///< in which patterns are sought
constexpr std::size_t kMostRows = 4096;

/// Of groups and counts (\( \{ \1) the matcher's memory would have no bound.
bool is_plain(std::string_view pattern) {
    for (std::size_t i = 0; i + 1 < pattern.size(); ++i) {
        if (pattern[i] != '\\') continue;
        ++i;
        if (pattern[i] == '(' || pattern[i] == '{' || (pattern[i] >= '0' && pattern[i] <= '9'))
            return false;
    }
    return true;
}

Regex compile_pattern(std::string_view pattern, const SourceLocation& where) {
    if (pattern.empty() || pattern.size() > kLongestPattern || !is_plain(pattern))
        throw InputError(where, "bad pattern, expected at most " + std::to_string(kLongestPattern) +
                                    " characters without \\(, \\{ and \\1");
    auto compiled = std::make_unique<regex_t>();
    if (regcomp(compiled.get(), std::string(pattern).c_str(), REG_ICASE | REG_NOSUB) != 0)
        throw InputError(where, "bad pattern: not a regular expression");
    return Regex(compiled.release());
}

}  // namespace

struct LampTable::Row {
    Regex pattern;
    Lamp lamp;
    std::string alias;  ///< "" where `lamp` is given
};

LampTable::~LampTable() = default;
LampTable::LampTable(LampTable&&) noexcept = default;
LampTable& LampTable::operator=(LampTable&&) noexcept = default;

Rgb Lamp::color() const {
    return static_cast<float>(depreciation) * color_from_xyz({x / y, 1, (1 - x - y) / y});
}

LampTable::LampTable(std::string_view text, const std::string& name) {
    SourceLocation where{name, 0};
    const auto share = [&where](std::string_view& line, const char* what) {
        double value = 0;
        if (!parse_real(take_word(line), value) || !(value >= 0 && value <= 1))
            throw InputError(where, std::string("expected ") + what + " from 0 to 1");
        return value;
    };
    while (!text.empty()) {
        ++where.line;
        std::string_view line = take_line(text);
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.empty() || line.front() == '#') continue;
        const std::size_t end = line.find(line.front(), 1);
        if (end == std::string_view::npos)
            throw InputError(where, std::string("the pattern has no second ") + line.front());
        if (rows_.size() == kMostRows) throw InputError(where, "too many lamps");
        Row row{compile_pattern(line.substr(1, end - 1), where), {}, {}};
        line.remove_prefix(end + 1);
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.starts_with('(')) {
            row.alias = line.substr(1, std::min(line.find(')'), line.size()) - 1);
            if (row.alias.empty()) throw InputError(where, "expected a lamp's name between ( )");
        } else {
            row.lamp.x = share(line, "chromaticity x");
            row.lamp.y = share(line, "chromaticity y");
            row.lamp.depreciation = share(line, "the depreciation");
            if (row.lamp.y == 0) throw InputError(where, "chromaticity y is 0");
        }
        rows_.push_back(std::move(row));
    }
}

std::optional<Lamp> LampTable::find(std::string_view text) const {
    std::string wanted(text.substr(0, kLongestLine));
    for (std::size_t steps = 0; steps <= rows_.size(); ++steps) {  // aliases may form a circle
        const auto row = std::ranges::find_if(rows_, [&wanted](const Row& r) {
            return regexec(r.pattern.get(), wanted.c_str(), 0, nullptr, 0) == 0;
        });
        if (row == rows_.end()) return std::nullopt;
        if (row->alias.empty()) return row->lamp;
        wanted = row->alias;
    }
    return std::nullopt;
}

}  // namespace lightwalk
