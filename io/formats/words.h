#pragma once
// Lines and words of Radiance's text formats.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lightwalk {

/// Remove the next line from the front of `text` and return it without its LF or CR LF.
[[nodiscard]] std::string_view take_line(std::string_view& text);

/// Remove the next word (characters between white space) from the front of `text` and return it;
/// empty at the end.
[[nodiscard]] std::string_view take_word(std::string_view& text);

/// Reads the words of a data or font file. They are separated by white space; `#`, also directly
/// after a word, begins a comment that extends to the end of the line.
class WordReader {
  public:
    WordReader(std::string_view text, std::string name) : rest_(text), where_{std::move(name), 1} {}

    /// The next word; nothing at the end. Throws InputError for words of more than 63 characters.
    [[nodiscard]] std::optional<std::string_view> next();
    /// An upper bound of the number of words that follow, against which counts in the file are
    /// checked before memory is allocated for them.
    [[nodiscard]] std::size_t most_left() const { return (rest_.size() + 1) / 2; }
    [[nodiscard]] InputError error(const std::string& problem) const { return {where_, problem}; }

  private:
    void skip_blanks();
    std::string_view rest_;
    SourceLocation where_;
};

/// A text without the blanks at its ends.
[[nodiscard]] std::string_view without_blanks(std::string_view text);

}  // namespace lightwalk
