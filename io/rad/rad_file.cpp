#include "io/rad/rad_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "io/formats/words.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

struct RadVariable {
    std::string_view name;
    std::size_t shortest;  ///< letters that are enough
    bool many = false;     ///< has many values
};

constexpr std::array kRadVariables{
    RadVariable{"AMBFILE", 3},         RadVariable{"DETAIL", 3},
    RadVariable{"EXPOSURE", 3},        RadVariable{"EYESEP", 3},
    RadVariable{"illum", 3, true},     RadVariable{"INDIRECT", 3},
    RadVariable{"materials", 3, true}, RadVariable{"mkillum", 3, true},
    RadVariable{"objects", 3, true},   RadVariable{"oconv", 3, true},
    RadVariable{"OCTREE", 3},          RadVariable{"OPTFILE", 2},
    RadVariable{"PENUMBRAS", 3},       RadVariable{"pfilt", 2, true},
    RadVariable{"PICTURE", 2},         RadVariable{"QUALITY", 3},
    RadVariable{"RAWFILE", 2},         RadVariable{"render", 3, true},
    RadVariable{"REPORT", 3},          RadVariable{"RESOLUTION", 3},
    RadVariable{"rpict", 3, true},     RadVariable{"rvu", 3, true},
    RadVariable{"scene", 3, true},     RadVariable{"UP", 2},
    RadVariable{"VARIABILITY", 3},     RadVariable{"view", 2, true},
    RadVariable{"ZFILE", 2},           RadVariable{"ZONE", 2}};

constexpr std::string_view kSpaces = " \t\r\n\f\v";

const RadVariable* find_variable(std::string_view name) {
    const auto* const found = std::ranges::find_if(kRadVariables, [&](const RadVariable& variable) {
        return name.size() >= variable.shortest && variable.name.starts_with(name);
    });
    return found != kRadVariables.end() ? found : nullptr;
}

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
    return text.substr(0, text.find_last_not_of(kSpaces) + 1);  // npos + 1 is 0
}

/// The name that an assignment begins with, and what is behind it and the equals sign, if there is
/// one.
std::pair<std::string_view, std::string_view> split_assignment(std::string_view text) {
    text = trimmed(text);
    const std::size_t end = std::min(text.find_first_of("= \t\r\n\f\v"), text.size());
    std::string_view value = trimmed(text.substr(end));
    if (value.starts_with('=')) value = trimmed(value.substr(1));
    return {text.substr(0, end), value};
}

}  // namespace

std::vector<RadValue> RadFile::values(std::string_view variable) const {
    const auto found = values_.find(variable);
    return found != values_.end() ? found->second : std::vector<RadValue>();
}

const RadValue* RadFile::value(std::string_view variable) const {
    const auto found = values_.find(variable);
    return found != values_.end() ? &found->second.back() : nullptr;
}

void RadFile::assign(std::string_view assignment, const SourceLocation& where) {
    const auto [name, value] = split_assignment(assignment);
    const RadVariable* const variable = find_variable(name);
    if (variable == nullptr) {
        std::vector<std::string> known;
        known.reserve(kRadVariables.size());
        for (const RadVariable& v : kRadVariables) known.emplace_back(v.name);
        const std::optional<std::string> nearest = nearest_name(name, known);
        throw InputError(where, "unknown variable \"" + std::string(name) + '"' +
                                    (nearest ? ", did you mean " + *nearest + '?'
                                             : ": expected one of rad(1), as \"scene= FILES\""));
    }
    if (value.empty()) return;
    std::vector<RadValue>& all = values_[std::string(variable->name)];
    if (!all.empty() && !variable->many) {
        if (all.back().where.file == where.file)  // else it is set on purpose
            warnings_.push_back(to_prefix(where) + std::string(variable->name) +
                                "= is assigned twice: the last value counts");
        all.clear();
    }
    all.push_back({std::string(value), where});
}

bool is_rad_assignment(std::string_view word) {
    const std::size_t end = word.find('=');
    return end != std::string_view::npos && find_variable(word.substr(0, end)) != nullptr;
}

RadFile decode_rad_file(std::string_view text, const std::string& name) {
    RadFile file(name);
    std::int32_t number = 1;
    while (!text.empty()) {
        const SourceLocation where{name, number};
        std::string assignment;
        for (bool more = true; more && !text.empty(); ++number) {
            std::string_view line = take_line(text);
            line = line.substr(0, line.find('#'));
            more = line.ends_with('\\');
            if (more) line.remove_suffix(1);
            assignment += line;
            assignment += ' ';
        }
        if (!trimmed(assignment).empty()) file.assign(assignment, where);
    }
    return file;
}

std::vector<std::string> words_of(const RadValue& value) {
    const std::string_view text = value.text;
    std::vector<std::string> words;
    bool in_word = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (kSpaces.find(text[i]) != std::string_view::npos) {
            in_word = false;
            continue;
        }
        if (!std::exchange(in_word, true)) words.emplace_back();
        if (text[i] != '\'' && text[i] != '"') {
            words.back() += text[i];
            continue;
        }
        const std::size_t end = text.find(text[i], i + 1);
        if (end == std::string_view::npos)
            throw InputError(value.where, "a quote that does not end: " + value.text.substr(i));
        words.back() += text.substr(i + 1, end - i - 1);
        i = end;
    }
    return words;
}

}  // namespace lightwalk
