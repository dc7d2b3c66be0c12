#pragma once
// Words of the scene language: white space, quotes, comments and commands.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace lightwalk {

/// Walks over scene text. Keeps the line number for messages.
class SceneTokenizer {
  public:
    SceneTokenizer(std::string_view text, std::string file)
        : text_(text), where_{std::move(file), 1} {}

    enum class Item { end, comment, command, primitive };
    /// Skip white space and tell what begins here; does not consume it.
    [[nodiscard]] Item peek();
    std::string_view comment();  ///< consume the rest of the line, '#' included
    /// Consume to the end of the line, '!' included. Backslash-newline does not end it; both
    /// characters are kept.
    [[nodiscard]] std::string command();
    /// Next word with quotes removed; nothing at the end of the text. Words longer than 64 KiB are
    /// an InputError.
    [[nodiscard]] std::optional<std::string> word();
    [[nodiscard]] const SourceLocation& where() const { return where_; }

  private:
    void skip_to(std::size_t end);
    void skip_white_space();

    std::string_view text_;
    std::size_t at_ = 0;
    SourceLocation where_;
};

}  // namespace lightwalk
