#pragma once
// Words of the scene language: white space, quotes, comments and commands.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace lightwalk {

/// Walks over scene text, of which it keeps no copy. Keeps the line number for messages.
class SceneTokenizer {
  public:
    /// @param line  of the text's first character, for text that is a piece of a longer one
    SceneTokenizer(std::string_view text, FileName file, std::int32_t line = 1)
        : text_(text), where_{std::move(file), line} {}

    enum class Item { end, comment, command, primitive };
    /// Skip white space and tell what begins here; does not consume it.
    [[nodiscard]] Item peek();
    std::string_view comment();  ///< consume the rest of the line, '#' included
    /// Consume to the end of the line, '!' included. Backslash-newline does not end it; both
    /// characters are kept.
    [[nodiscard]] std::string command();
    /// Next word with quotes removed; nothing at the end of the text. It stays as it is until the
    /// next word is asked for, and no longer than the text. Words longer than 64 KiB are an
    /// InputError.
    [[nodiscard]] std::optional<std::string_view> word();
    /// The next word where it is a number that parse_simple_real takes; else it is not consumed.
    [[nodiscard]] bool simple_real(double& value);
    [[nodiscard]] const SourceLocation& where() const { return where_; }
    /// How many characters of the text have been read, and how many not.
    [[nodiscard]] std::size_t offset() const { return at_; }
    [[nodiscard]] std::size_t left() const { return text_.size() - at_; }

  private:
    void skip_to(std::size_t end);
    void skip_white_space();
    [[nodiscard]] std::string_view quoted_word();

    std::string_view text_;
    std::size_t at_ = 0;
    SourceLocation where_;
    std::string unquoted_;  ///< the last word, where it is not as in the text
};

}  // namespace lightwalk
