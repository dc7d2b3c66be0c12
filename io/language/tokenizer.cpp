#include "io/language/tokenizer.h"

#include <algorithm>

#include "io/language/number_text.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLongestWord = std::size_t{64} << 10;
constexpr const char* kTooLong = "word longer than 64 KiB";

constexpr bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

constexpr bool ends_line(std::string_view text, std::size_t at) {
    const char c = text[at];
    return c == '\n' || (c == '\r' && (at + 1 >= text.size() || text[at + 1] != '\n'));
}

}  // namespace

/// Move to `end`, counting lines: LF, CR LF and a lone CR end one.
void SceneTokenizer::skip_to(std::size_t end) {
    for (; at_ < end; ++at_) {
        if (ends_line(text_, at_)) ++where_.line;
    }
}

void SceneTokenizer::skip_white_space() {
    for (; at_ < text_.size() && is_space(text_[at_]); ++at_) {
        if (text_[at_] != ' ' && ends_line(text_, at_)) ++where_.line;
    }
}

SceneTokenizer::Item SceneTokenizer::peek() {
    skip_white_space();
    if (at_ >= text_.size()) return Item::end;
    if (text_[at_] == '#') return Item::comment;
    return text_[at_] == '!' ? Item::command : Item::primitive;
}

std::string_view SceneTokenizer::comment() {
    const std::size_t begin = at_;
    const std::size_t end = std::min(text_.find('\n', begin), text_.size());
    skip_to(end);
    return text_.substr(begin, end - begin);
}

std::string SceneTokenizer::command() {
    const std::size_t begin = at_;
    std::size_t end = begin;
    for (; end < text_.size(); ++end) {
        if (text_[end] != '\n' && text_[end] != '\r') continue;
        if (text_[end - 1] != '\\') break;  // the '!' stands before, so there is a character
        if (text_.substr(end, 2) == "\r\n") ++end;
    }
    skip_to(end);
    return std::string(text_.substr(begin, end - begin));
}

std::optional<std::string_view> SceneTokenizer::word() {
    skip_white_space();
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t begin = at_;
    std::size_t end = begin;
    for (; end < text_.size() && !is_space(text_[end]); ++end) {
        if (text_[end] == '"' || text_[end] == '\'') return quoted_word();
    }
    if (end - begin > kLongestWord) throw InputError(where_, kTooLong);
    at_ = end;  // the line number stays: a word without quotes has no line end in it
    return text_.substr(begin, end - begin);
}

/// The word that begins here, some of which is quoted.
std::string_view SceneTokenizer::quoted_word() {
    unquoted_.clear();
    char quote = 0;
    std::size_t end = at_;
    for (; end < text_.size(); ++end) {
        const char c = text_[end];
        if (quote == 0 && is_space(c)) break;
        if (c == quote) {
            quote = 0;
        } else if (quote == 0 && (c == '"' || c == '\'')) {
            quote = c;
        } else {
            if (unquoted_.size() >= kLongestWord) throw InputError(where_, kTooLong);
            unquoted_.push_back(c);
        }
    }
    skip_to(end);
    return unquoted_;
}

bool SceneTokenizer::simple_real(double& value) {
    skip_white_space();
    const std::size_t size = parse_simple_real(text_.substr(at_), value);
    if (size == 0 || (size < left() && !is_space(text_[at_ + size]))) return false;
    at_ += size;
    return true;
}

}  // namespace lightwalk
