#include "io/options/view_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "core/error.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLargestViewText = 1 << 20;  // of a view file; pictures may follow

/// What an option sets: one number, or three.
struct Target {
    double* number = nullptr;
    Vec3* vector = nullptr;
};

Target target_of(char letter, View& view) {
    switch (letter) {
        case 'p':
            return {nullptr, &view.position};
        case 'd':
            return {nullptr, &view.direction};
        case 'u':
            return {nullptr, &view.up};
        case 'h':
            return {&view.horizontal, nullptr};
        case 'v':
            return {&view.vertical, nullptr};
        case 'o':
            return {&view.fore, nullptr};
        case 'a':
            return {&view.aft, nullptr};
        case 's':
            return {&view.shift, nullptr};
        case 'l':
            return {&view.lift, nullptr};
        default:
            return {};
    }
}

/// Words that a view option takes after itself, or nothing when the word is none. -vt has its
/// argument attached; -vf is not among them.
std::optional<std::size_t> argument_count(std::string_view word) {
    if (!word.starts_with("-v") || word.size() < 3) return std::nullopt;
    if (word[2] == 't') return word.size() <= 4 ? std::optional<std::size_t>(0) : std::nullopt;
    if (word.size() != 3) return std::nullopt;
    View view;
    const Target target = target_of(word[2], view);
    if (target.vector != nullptr) return 3;
    if (target.number != nullptr) return 1;
    return std::nullopt;
}

/// Apply an option that argument_count knows; false, and nothing changed, when an argument is no
/// number.
bool apply(std::string_view option, std::span<const std::string_view> arguments, View& view) {
    if (option[2] == 't') {
        if (option.size() != 4) return false;
        view.type = option[3];
        return true;
    }
    std::array<double, 3> value{};
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (!parse_real(arguments[i], value[i])) return false;
    }
    const Target target = target_of(option[2], view);
    if (target.vector != nullptr)
        *target.vector = {value[0], value[1], value[2]};
    else
        *target.number = value[0];
    return true;
}

/// Whether a program's name or variable at the line's beginning announces a view; what follows is
/// returned.
std::optional<std::string_view> after_view_word(std::string_view line) {
    constexpr std::array<std::string_view, 8> kWords{"VIEW=",  "rpict",   "rview",   "rvu",
                                                     "rpiece", "rxpiece", "pinterp", "lightwalk"};
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    std::string_view word = line.substr(0, end);
    word.remove_prefix(std::min(word.rfind('/') + 1, word.size()));  // npos + 1 is 0
    const bool announces = std::any_of(kWords.begin(), kWords.end(),
                                       [&](std::string_view w) { return word.starts_with(w); });
    if (!announces) return std::nullopt;
    return line.substr(end);
}

}  // namespace

std::string view_text(const View& view) {
    std::array<char, 512> text{};
    const Vec3 &p = view.position, &d = view.direction, &u = view.up;
    (void)std::snprintf(
        text.data(), text.size(),
        "-vt%c -vp %.7g %.7g %.7g -vd %.7g %.7g %.7g -vu %.5g %.5g %.5g -vh %.5g -vv %.5g "
        "-vo %.5g -va %.5g -vs %.5g -vl %.5g",
        view.type, p.x, p.y, p.z, d.x, d.y, d.z, u.x, u.y, u.z, view.horizontal, view.vertical,
        view.fore, view.aft, view.shift, view.lift);
    return text.data();
}

std::size_t parse_view_option(std::span<const std::string> words, View& view, FileSource& files) {
    if (words.empty()) return 0;
    const std::string& option = words.front();
    if (option == "-vf") {
        if (words.size() < 2) throw InputError("option -vf: expected the name of a view file");
        const std::optional<std::string> text =
            files.answer(FileSource::Question::beginning, words[1], kLargestViewText);
        read_view_file(text.value_or(""), words[1], view);
        return 2;
    }
    const std::optional<std::size_t> count = argument_count(option);
    if (!count) return 0;
    const std::vector<std::string_view> arguments(words.begin() + 1, words.end());
    const std::size_t found = std::min(*count, arguments.size());
    if (found < *count || !apply(option, std::span(arguments).first(found), view)) {
        std::string got;
        for (std::size_t i = 0; i < found; ++i) got += ' ' + words[i + 1];
        throw InputError("option " + option + got + ": expected " +
                         (*count == 3   ? "three numbers"
                          : *count == 1 ? "a number"
                                        : "one of the letters v l h c a s behind -vt"));
    }
    return 1 + *count;
}

int parse_view_string(std::string_view text, View& view) {
    int applied = 0;
    while (!text.empty()) {
        const std::string_view option = take_word(text);
        const std::optional<std::size_t> count = argument_count(option);
        if (!count) continue;
        std::array<std::string_view, 3> arguments{};
        std::string_view rest = text;
        for (std::size_t i = 0; i < *count; ++i) arguments[i] = take_word(rest);
        if (!apply(option, std::span(arguments).first(*count), view)) continue;
        text = rest;
        ++applied;
    }
    return applied;
}

void read_view_file(std::string_view text, const std::string& name, View& view) {
    int applied = 0;
    const bool header = !text.empty() && text.front() >= ' ' && text.front() <= '~';
    text = text.substr(0, header ? kLargestViewText : 0);
    while (!text.empty()) {
        const std::string_view line = take_line(text);
        if (line.empty()) break;
        if (const std::optional<std::string_view> rest = after_view_word(line)) {
            applied += parse_view_string(*rest, view);
        }
    }
    if (applied == 0) {
        throw InputError({name, 0}, "bad view file: no line like \"VIEW= -vp x y z -vd x y z\"");
    }
}

std::vector<View> read_view_sequence(std::string_view text, View view) {
    std::vector<View> frames;
    while (!text.empty()) {
        const std::optional<std::string_view> rest = after_view_word(take_line(text));
        if (rest && parse_view_string(*rest, view) > 0) frames.push_back(view);
    }
    return frames;
}

}  // namespace lightwalk
