#pragma once
// Lines and words of Radiance's text formats.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lightwalk {

/// Take the next line off the front of `text`, without its LF or CR LF.
[[nodiscard]] std::string_view take_line(std::string_view& text);

/// Take the next word (between white space) off the front of `text`; empty at the end.
[[nodiscard]] std::string_view take_word(std::string_view& text);

/// The words of a data or font file: separated by white space, `#` begins a comment to the end of
/// the line, also directly behind a word.
class WordReader {
  public:
    WordReader(std::string_view text, std::string name) : rest_(text), where_{std::move(name), 1} {}

    /// Nothing at the end. Throws InputError for words of more than 63 characters.
    [[nodiscard]] std::optional<std::string_view> next();
    /// No more words than this can follow: what counts in the file are checked against.
    [[nodiscard]] std::size_t most_left() const { return (rest_.size() + 1) / 2; }
    [[nodiscard]] InputError error(const std::string& problem) const { return {where_, problem}; }

  private:
    void skip_blanks();
    std::string_view rest_;
    SourceLocation where_;
};

}  // namespace lightwalk
