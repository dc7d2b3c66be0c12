#include "io/formats/words.h"

#include <algorithm>

namespace lightwalk {
namespace {

constexpr std::size_t kLongestTableWord = 63;

bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

std::string_view take_word(std::string_view& text) {
    const auto* begin = std::find_if_not(text.begin(), text.end(), is_blank);
    const auto* end = std::find_if(begin, text.end(), is_blank);
    const std::string_view word = text.substr(static_cast<std::size_t>(begin - text.begin()),
                                              static_cast<std::size_t>(end - begin));
    text.remove_prefix(static_cast<std::size_t>(end - text.begin()));
    return word;
}

void WordReader::skip_blanks() {
    while (!rest_.empty()) {
        if (rest_.front() == '#') {
            rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
            continue;
        }
        if (!is_blank(rest_.front())) return;
        if (rest_.front() == '\n') ++where_.line;
        rest_.remove_prefix(1);
    }
}

std::optional<std::string_view> WordReader::next() {
    skip_blanks();
    if (rest_.empty()) return std::nullopt;
    const auto* end =
        std::find_if(rest_.begin(), rest_.end(), [](char c) { return is_blank(c) || c == '#'; });
    const std::string_view word = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    if (word.size() > kLongestTableWord) {
        throw error("word of " + std::to_string(word.size()) + " characters, expected at most 63");
    }
    rest_.remove_prefix(word.size());
    return word;
}

std::string_view without_blanks(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\v\f";
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

}  // namespace lightwalk
