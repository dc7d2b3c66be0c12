#pragma once
// The tokenizer of the scene language: words, quotes, comments and commands.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace lightwalk {

/// Reads scene text from front to back, and counts lines for messages. The text is not copied.
class SceneTokenizer {
  public:
    /// @param line  the line number of the text's first character, for a part of a longer text
    SceneTokenizer(std::string_view text, FileName file, std::int32_t line = 1)
        : text_(text), where_{std::move(file), line} {}

    enum class Item { end, comment, command, primitive };
    /// Skip white space and return the kind of item that begins there, without consuming it.
    [[nodiscard]] Item peek();
    std::string_view comment();  ///< consume and return the rest of the line, '#' included
    /// Consume and return a command up to the end of the line, '!' included. A backslash before the
    /// line end continues it; both characters are kept.
    [[nodiscard]] std::string command();
    /// Consume and return the next word, with quotes removed; nothing at the end of the text. The
    /// view is valid until the next call, and no longer than the text. Throws InputError for words
    /// longer than 64 KiB.
    [[nodiscard]] std::optional<std::string_view> word();
    /// Consume the next word if parse_simple_real() can read it; else return false.
    [[nodiscard]] bool simple_real(double& value);
    [[nodiscard]] const SourceLocation& where() const { return where_; }
    /// How many characters of the text have been consumed, and how many are left.
    [[nodiscard]] std::size_t offset() const { return at_; }
    [[nodiscard]] std::size_t left() const { return text_.size() - at_; }

  private:
    void skip_to(std::size_t end);
    void skip_white_space();
    [[nodiscard]] std::string_view quoted_word();

    std::string_view text_;
    std::size_t at_ = 0;
    SourceLocation where_;
    std::string unquoted_;  ///< the last word, if it differs from its text because of quotes
};

}  // namespace lightwalk
