#include "io/language/tokenizer.h"

#include <algorithm>

namespace lightwalk {
namespace {

constexpr std::size_t kLongestToken = std::size_t{64} << 10;

constexpr bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

/// Move to `end`, counting lines: LF, CR LF and a lone CR end one.
void SceneTokenizer::skip_to(std::size_t end) {
    for (; at_ < end; ++at_) {
        const char c = text_[at_];
        const bool lone_return = c == '\r' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '\n');
        if (c == '\n' || lone_return) ++where_.line;
    }
}

void SceneTokenizer::skip_white_space() {
    std::size_t end = at_;
    while (end < text_.size() && is_space(text_[end])) ++end;
    skip_to(end);
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

std::optional<std::string> SceneTokenizer::word() {
    skip_white_space();
    if (at_ >= text_.size()) return std::nullopt;
    std::string result;
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
            if (result.size() >= kLongestToken) throw InputError(where_, "word longer than 64 KiB");
            result.push_back(c);
        }
    }
    skip_to(end < text_.size() ? end + 1 : end);
    return result;
}

}  // namespace lightwalk
