#pragma once
// Lexer of the function language: numbers, names, punctuation; comments in braces.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lightwalk::function {

/// Reads a text from front to back, skipping white space and comments; an unterminated comment
/// throws InputError.
class Lexer {
  public:
    /// `where` is the place of the first character; lines are counted from there on when it has
    /// one.
    Lexer(std::string_view text, SourceLocation where);

    /// The next character that is neither white space nor comment; 0 at the end.
    [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
    /// Take one character of punctuation.
    void advance();
    /// Take `c` when it is next.
    bool accept(char c);
    void expect(char c, std::string_view what);

    /// Take a number; throws InputError for a badly formed one.
    double number();
    /// Take an integer of digits; 0 when there are none, and no more than 10^9.
    std::uint32_t integer();
    /// Take a name: at most 127 characters of it count.
    std::string name();
    [[nodiscard]] bool at_number() const;
    [[nodiscard]] bool at_name() const;

    [[nodiscard]] const SourceLocation& where() const { return where_; }
    /// Throws "syntax error: found ..., expected `what`".
    [[noreturn]] void unexpected(std::string_view what) const;

  private:
    void skip();
    void skip_comment();

    std::string_view text_;
    std::size_t at_ = 0;
    SourceLocation where_;
};

}  // namespace lightwalk::function
