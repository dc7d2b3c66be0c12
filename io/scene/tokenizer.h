#pragma once
// Words of the scene language: white space, quotes, comments and commands.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lightwalk {

/// Walks over scene text. Keeps the line number for messages.
class SceneTokenizer {
  public:
    SceneTokenizer(std::string_view text, std::string file) : text_(text), where_{std::move(file), 1} {}

    enum class Item { end, comment, command, primitive };
    /// Skip white space and tell what begins here; does not consume it.
    [[nodiscard]] Item peek();
    [[nodiscard]] std::string_view comment();  ///< consume the rest of the line, '#' included
    [[nodiscard]] std::string command();       ///< consume to the end of the line (backslash-newline continues), '!' included
    /// Next word with quotes removed; nothing at the end of the text. Words longer than 64 KiB are an InputError.
    [[nodiscard]] std::optional<std::string> word();
    [[nodiscard]] const SourceLocation& where() const { return where_; }

  private:
    std::string_view text_;
    std::size_t at_ = 0;
    SourceLocation where_;
};

}  // namespace lightwalk
