#include "io/options/manual_page.h"

#include <algorithm>
#include <sstream>

namespace lightwalk {
namespace {

/// A line of text that roff prints as it is.
std::string plain(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";  // a minus that can be searched for, and copied to a shell
        else
            escaped += c;
    }
    if (escaped.starts_with('.') || escaped.starts_with('\'')) escaped.insert(0, "\\&");
    return escaped;
}

/// The argument of a macro.
std::string quoted(const std::string& text) {
    std::string escaped = plain(text);
    for (std::size_t at = 0; (at = escaped.find('"', at)) != std::string::npos; at += 4)
        escaped.replace(at, 1, "\\(dq");
    return '"' + escaped + '"';
}

/// Paragraphs; what is indented keeps its lines.
std::string paragraphs(const std::string& text) {
    std::istringstream lines(text);
    std::string page;
    bool begins = true, literal = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty()) {
            begins = true;
            continue;
        }
        const bool indented = line.starts_with(' ');
        if (literal && !indented) page += ".fi\n.RE\n";
        if (begins) page += ".PP\n";
        if (indented && !literal) page += ".RS 2\n.nf\n";
        literal = indented;
        begins = false;
        page += plain(indented ? line.substr(2) : line) + '\n';
    }
    return page + (literal ? ".fi\n.RE\n" : "");
}

/// Lines of an option's explanation.
std::string explanation(const OptionRow& row) {
    const std::string value = row.default_text();
    std::istringstream lines(row.help() + (value.empty() ? "" : " (default " + value + ")"));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        if (!text.empty()) text += ".br\n";
        text += plain(line) + '\n';
    }
    return text.empty() ? "\\&\n" : text;
}

std::string options_section(const OptionTable& options) {
    std::string page = ".SH OPTIONS\n", title, begun;
    for (const OptionRow& row : options.rows()) {
        if (std::holds_alternative<SectionTitle>(row.place)) title = row.words;
        if (!row.offered()) continue;
        if (title != begun) page += ".SS " + quoted(title) + '\n';
        begun = title;
        const std::size_t end = std::min(row.words.find(' '), row.words.size());
        page += ".TP\n\\fB" + plain(row.words.substr(0, end)) + "\\fR" +
                plain(row.words.substr(end)) + '\n' + explanation(row);
    }
    return page;
}

}  // namespace

std::string manual_page(const ManualText& text, const OptionTable* options,
                        const std::string& version) {
    std::string title = text.name;
    std::ranges::transform(title, title.begin(), [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    std::string page = ".TH " + quoted(title) + " 1 \"\" " + quoted("Lightwalk " + version) +
                       " \"User Commands\"\n.SH NAME\n" + plain(text.name) + " \\- " +
                       plain(text.summary) + "\n.SH SYNOPSIS\n\\fB" + plain(text.call) + "\\fR " +
                       plain(text.operands) + "\n.SH DESCRIPTION\n" + paragraphs(text.about);
    if (options != nullptr) page += options_section(*options);
    if (!text.example.empty()) page += ".SH EXAMPLES\n" + paragraphs(text.example);
    if (!text.see_also.empty()) page += ".SH SEE ALSO\n" + plain(text.see_also) + '\n';
    return page;
}

}  // namespace lightwalk
