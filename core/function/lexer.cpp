#include "core/function/lexer.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "core/function/symbols.h"

namespace lightwalk::function {
namespace {

constexpr std::size_t kLongestName = 127;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

/// The power of ten of the first digit of `word` that is not 0; `word` is digits [. digits] [e
/// digits].
long long decimal_exponent(std::string_view word) {
    const std::size_t mark = std::min(word.find_first_of("eE"), word.size());
    const std::string_view mantissa = word.substr(0, mark);
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
    long long exponent = static_cast<long long>(point) - static_cast<long long>(first);
    if (mark < word.size()) {
        const bool negative = word[mark + 1] == '-';
        long long e = 0;
        for (const char c : word.substr(mark + 1)) {
            if (is_digit(c)) e = std::min(e * 10 + (c - '0'), 1LL << 40);
        }
        exponent += negative ? -e : e;
    }
    return exponent;
}

/// As the C library converts: too large is infinite, too small is 0.
double to_double(std::string_view word) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range) {
        return decimal_exponent(word) > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    }
    return value;
}

std::string quoted(char c) {
    if (c >= ' ' && c <= '~') return std::string("'") + c + "'";
    return "byte " + std::to_string(static_cast<unsigned char>(c));
}

}  // namespace

Lexer::Lexer(std::string_view text, SourceLocation where) : text_(text), where_(std::move(where)) {
    skip();
}

void Lexer::unexpected(std::string_view what) const {
    const std::string found = at_end() ? std::string("the end") : quoted(peek());
    throw InputError(where_, "syntax error: found " + found + ", expected " + std::string(what));
}

void Lexer::skip() {
    for (; at_ < text_.size(); ++at_) {
        if (text_[at_] == '{') {
            skip_comment();
        } else if (!is_space(text_[at_])) {
            return;
        } else if (text_[at_] == '\n' && where_.line > 0) {
            ++where_.line;
        }
    }
}

void Lexer::skip_comment() {
    const SourceLocation start = where_;
    std::size_t depth = 0;
    for (; at_ < text_.size(); ++at_) {
        if (text_[at_] == '{') ++depth;
        if (text_[at_] == '}' && --depth == 0) return;
        if (text_[at_] == '\n' && where_.line > 0) ++where_.line;
    }
    throw InputError(start, "'}' expected: this comment does not end");
}

void Lexer::advance() {
    ++at_;
    skip();
}

bool Lexer::accept(char c) {
    if (at_end() || peek() != c) return false;
    advance();
    return true;
}

void Lexer::expect(char c, std::string_view what) {
    if (!accept(c)) unexpected(what);
}

bool Lexer::at_number() const {
    return is_digit(peek()) || peek() == '.';
}
bool Lexer::at_name() const {
    return is_letter(peek()) || peek() == '`';
}

double Lexer::number() {
    const std::size_t start = at_;
    const auto digits = [this] {
        const std::size_t before = at_;
        while (is_digit(peek())) ++at_;
        return at_ > before;
    };
    const bool whole = digits();
    if (peek() == '.') {
        ++at_;
        if (!digits() && !whole)
            throw InputError(where_, "badly formed number: no digit beside the '.'");
    }
    if (peek() == 'e' || peek() == 'E') {
        ++at_;
        if (peek() == '+' || peek() == '-') ++at_;
        if (!digits())
            throw InputError(where_, "missing exponent: no digit after the 'e' of a number");
    }
    const double value = to_double(text_.substr(start, at_ - start));
    skip();
    return value;
}

std::uint32_t Lexer::integer() {
    std::uint64_t value = 0;
    for (; is_digit(peek()); ++at_) {
        value = std::min<std::uint64_t>(value * 10 + static_cast<std::uint64_t>(peek() - '0'),
                                        1000000000);
    }
    skip();
    return static_cast<std::uint32_t>(value);
}

std::string Lexer::name() {
    const std::size_t start = at_;
    while (!at_end() && is_name_character(peek())) ++at_;
    std::string word(text_.substr(start, std::min(at_ - start, kLongestName)));
    skip();
    return word;
}

}  // namespace lightwalk::function
