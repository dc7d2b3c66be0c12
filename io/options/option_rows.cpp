#include "io/options/option_rows.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

std::string formatted(const char* format, double value) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string formatted(const char* format, double x, double y, double z) {
    return formatted(format, x) + ' ' + formatted(format, y) + ' ' + formatted(format, z);
}

/// "a, b or c"; of more than three: "one of a, b, c, d".
std::string listed(const std::vector<std::string>& words) {
    const bool sentence = words.size() <= 3;
    std::string text = sentence ? "" : "one of ";
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += sentence && i + 1 == words.size() ? " or " : ", ";
        text += words[i];
    }
    return text;
}

/// What a number may be.
std::string range_text(const With& with) {
    if (with.expected != nullptr) return with.expected;
    const std::string what = with.divisor == kPercent ? "a percentage" : "a number",
                      least = formatted("%g", with.least);
    return (with.zero == nullptr ? "" : with.zero + std::string(" or ")) + what +
           (with.most == kUnlimited ? " of at least " + least
                                    : " from " + least + " to " + formatted("%.10g", with.most));
}

/// Reads an option and its arguments into a row's variable; false: it is another option.
struct ArgumentReader {
    OptionWords& words;
    const OptionRow& row;

    bool operator()(bool* place) const {
        const std::optional<bool> on = words.toggle(row.name(), row.attached() && *place);
        *place = on.value_or(*place);
        return on.has_value();
    }
    bool operator()(int* place) const {
        if (row.with.zero == nullptr) return set(*place, within_limits(words.integer()));
        const std::string text = words.text();
        long value = 0;
        const bool number = parse_integer(text, value) &&
                            static_cast<double>(value) >= row.with.least &&
                            static_cast<double>(value) <= row.with.most;
        if (!number && text != row.with.zero)
            refuse_argument(row.name(), range_text(row.with), '"' + text + '"');
        return set(*place, number ? value : 0);
    }
    bool operator()(std::uint64_t* place) const { return set(*place, words.unsigned_integer()); }
    bool operator()(float* place) const { return set(*place, real()); }
    bool operator()(double* place) const { return set(*place, real()); }
    bool operator()(Vec3* place) const {
        const double x = words.real(), y = words.real(), z = words.real();
        return set(*place, Vec3{x, y, z});
    }
    bool operator()(Rgb* place) const { return set(*place, words.rgb()); }
    bool operator()(std::string* place) const { return set(*place, words.text()); }
    bool operator()(const Choice& choice) const {
        const std::string word = words.text();
        const auto found = std::ranges::find(choice.words, word);
        if (found == choice.words.end())
            refuse_argument(row.name(), listed(choice.words), '"' + word + '"');
        choice.set(static_cast<std::size_t>(found - choice.words.begin()));
        return true;
    }
    bool operator()(const Action& action) const {
        action.act();
        words.skip(1);
        return true;
    }
    bool operator()(const CustomOption& custom) const {
        custom.take(words);
        return true;
    }
    bool operator()(const AttachedOption& attached) const { return attached.take(words); }
    bool operator()(const RefusedOption& refused) const {
        throw UsageError("option " + row.name() + refused.why);
    }
    bool operator()(const SectionTitle&) const { return false; }

  private:
    template <class Place, class Value>
    static bool set(Place& place, const Value& value) {
        place = static_cast<Place>(value);
        return true;
    }
    [[nodiscard]] double real() const {
        const bool whole = row.with.format == std::string_view("%.0f");
        return within_limits(whole ? words.integer() : words.real()) / row.with.divisor;
    }
    template <class Number>
    [[nodiscard]] Number within_limits(Number number) const {
        const auto value = static_cast<double>(number);
        if (!(value >= row.with.least) || value > row.with.most)
            refuse_argument(row.name(), range_text(row.with), formatted("%.10g", value));
        return number;
    }
};

/// Writes a row's value as one would write it behind the option.
struct ValueWriter {
    const OptionRow& row;
    const char* format;

    std::string operator()(bool* place) const { return !row.attached() ? "" : *place ? "+" : "-"; }
    std::string operator()(int* place) const {
        return *place == 0 && row.with.zero != nullptr ? row.with.zero : std::to_string(*place);
    }
    std::string operator()(std::uint64_t* place) const { return std::to_string(*place); }
    std::string operator()(float* place) const { return real(static_cast<double>(*place)); }
    std::string operator()(double* place) const { return real(*place); }
    std::string operator()(Vec3* a) const { return formatted(format, a->x, a->y, a->z); }
    std::string operator()(Rgb* c) const {
        return formatted(format, static_cast<double>(c->r), static_cast<double>(c->g),
                         static_cast<double>(c->b));
    }
    std::string operator()(std::string* place) const { return *place; }
    std::string operator()(const Choice& choice) const {
        return choice.get() < choice.words.size() ? choice.words[choice.get()] : "";
    }
    template <class Option>
    std::string operator()(const Option& option) const {
        if constexpr (requires { option.value; }) return option.value ? option.value() : "";
        return "";
    }

  private:
    [[nodiscard]] std::string real(double value) const {
        return formatted(format, value * row.with.divisor);
    }
};

/// An entry of help: `left`, and `text` in a column beside it.
std::string help_entry(const std::string& left, const std::string& text) {
    constexpr std::size_t kColumn = 21, kWidth = 100;
    std::string entry = "  " + left;
    entry.resize(std::max(entry.size() + 2, kColumn), ' ');
    std::size_t column = entry.size();
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
        const bool broken = at > 0 && text[at - 1] == '\n';
        if (broken || (at > 0 && column + 1 + end - at > kWidth)) {
            entry += '\n' + std::string(kColumn, ' ');
            column = kColumn;
        } else if (at > 0) {
            entry += ' ';
            ++column;
        }
        entry += text.substr(at, end - at);
        column += end - at;
        at = end + 1;
    }
    return entry + '\n';
}

/// Text in a cell of a table in Markdown.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find_first_of("|\n<", at)) != std::string::npos; at += 2)
        text.replace(at, 1, text[at] == '\n' ? "; " : std::string("\\") + text[at]);
    return text;
}

}  // namespace

void refuse_argument(const std::string& option, const std::string& expected,
                     const std::string& found) {
    throw UsageError("option " + option + ": expected " + expected + ", found " + found);
}

std::string OptionRow::name() const {
    const auto* attached = std::get_if<AttachedOption>(&place);
    return attached != nullptr ? attached->name : words.substr(0, words.find_first_of(" ["));
}

bool OptionRow::attached() const {
    return words.ends_with("[+-]") || std::holds_alternative<AttachedOption>(place);
}

bool OptionRow::offered() const {
    return !std::holds_alternative<SectionTitle>(place) &&
           !std::holds_alternative<RefusedOption>(place) && !with.hidden;
}

std::string OptionRow::comment() const {
    return text.substr(0, text.find(" |") == std::string::npos ? 0 : text.find(" |"));
}

std::string OptionRow::help() const {
    const std::string behind =
        text.substr(text.find(" | ") == std::string::npos ? 0 : text.find(" | ") + 3);
    return behind.ends_with(" |") ? comment() : behind;
}

std::string OptionRow::value(const char* format) const {
    return std::visit(ValueWriter{*this, format}, place);
}

std::string OptionRow::default_text() const {
    if (with.shown != nullptr) return with.shown;
    std::string present = value("%g");
    if (!std::holds_alternative<bool*>(place)) return present;
    return present == "+" ? "on" : present == "-" ? "off" : "";
}

OptionTable::OptionTable(std::pair<std::string, unsigned> command,
                         const std::vector<std::vector<OptionRow>>& groups,
                         std::vector<std::string> explained)
    : command_(std::move(command.first)), explained_(std::move(explained)) {
    for (const std::vector<OptionRow>& group : groups)
        std::ranges::copy_if(group, std::back_inserter(rows_), [&](const OptionRow& row) {
            return (row.with.commands & command.second) != 0;
        });
}

bool OptionTable::take(OptionWords& words) const {
    const std::string word = words.option();
    return std::ranges::any_of(rows_, [&](const OptionRow& row) {
        const bool meant = row.attached() ? word.starts_with(row.name()) : word == row.name();
        const bool taken =
            meant && (row.with.take ? row.with.take(words)
                                    : std::visit(ArgumentReader{words, row}, row.place));
        if (taken && row.with.then) row.with.then();
        return taken;
    });
}

void OptionTable::refuse(const OptionWords& words) const {
    std::vector<std::string> names;
    for (const OptionRow& row : rows_)
        if (row.offered()) names.push_back(row.name());
    const std::optional<std::string> meant = nearest_name(words.option(), names);
    throw UsageError("unknown option " + words.option() +
                     (meant ? ", did you mean " + *meant + "?" : ""));
}

std::string OptionTable::defaults() const {
    std::string text;
    for (const OptionRow& row : rows_) {
        if (row.with.lines)
            text += row.with.lines();
        else if (!row.comment().empty())
            text +=
                defaults_line(row.name() + (row.attached() ? "" : " ") + row.value(row.with.format),
                              row.comment());
    }
    return text;
}

std::string OptionTable::help() const {
    struct Named {
        std::string home, title, names;
    };
    std::vector<Named> elsewhere;
    std::string text, title, home, begun;  // begun: the title that stands over the last entry
    for (const OptionRow& row : rows_) {
        if (const auto* section = std::get_if<SectionTitle>(&row.place)) {
            title = row.words;
            home = section->home;
        }
        if (!row.offered()) continue;
        if (home.empty() || home == command_ ||
            std::ranges::find(explained_, row.name()) != explained_.end()) {
            if (begun != title) text += '\n' + title + '\n';
            begun = title;
            const std::string value = row.default_text();
            text += help_entry(row.words,
                               row.help() + (value.empty() ? "" : " (default " + value + ")"));
        } else {
            if (elsewhere.empty() || elsewhere.back().title != title)
                elsewhere.push_back({home, title, ""});
            elsewhere.back().names += ' ' + row.name();
        }
    }
    home.clear();
    for (const Named& section : elsewhere) {
        if (section.home != home)
            text += "\nAs `lightwalk " + section.home + " --help` explains, where they concern `" +
                    command_ + "`\n";
        home = section.home;
        const std::string title_only = section.title.substr(0, section.title.find_first_of(".,:"));
        text += help_entry(title_only + ':', section.names.substr(1));
    }
    return text;
}

std::string option_reference(const std::vector<OptionTable>& tables) {
    std::vector<std::pair<std::string, std::string>> lines;  // of an option, and who takes it
    for (const OptionTable& table : tables) {
        for (const OptionRow& row : table.rows()) {
            if (!row.offered()) continue;
            const std::string line = "| `" + cell(row.words) + "` | " + row.default_text() + " | " +
                                     cell(row.help()) + " | ";
            auto found =
                std::ranges::find(lines, line, &std::pair<std::string, std::string>::first);
            if (found == lines.end()) found = lines.insert(found, {line, ""});
            found->second += (found->second.empty() ? "" : ", ") + table.command();
        }
    }
    std::string text =
        "| option | default | what it does | commands |\n| --- | --- | --- | --- |\n";
    for (const auto& [line, takers] : lines) text += line + takers + " |\n";
    return text;
}

std::string defaults_line(const std::string& left, const std::string& comment) {
    constexpr std::size_t kColumn = 32;
    constexpr std::size_t kTab = 8;
    std::string line = left;
    for (std::size_t column = left.size() / kTab * kTab; column < kColumn; column += kTab)
        line += '\t';
    if (left.size() >= kColumn) line += '\t';
    return line + "# " + comment + '\n';
}

}  // namespace lightwalk
