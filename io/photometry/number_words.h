#pragma once
// Reads the numbers of photometric data files, which white space or commas separate.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace lightwalk {

/// A cursor over the words of a text. Every mistake is an InputError "NAME:LINE: ...".
class NumberWords {
  public:
    /// @param line  on which `text` begins
    NumberWords(std::string_view text, const FileName& name, std::int32_t line = 1)
        : rest_(text), where_{name, line} {}

    /// Consume a finite number; `what` is its name in messages.
    double real(std::string_view what);
    double not_negative(std::string_view what);
    /// Consume a whole number from `least` to `most`.
    long integer(std::string_view what, long least, long most);
    /// Consume a number of numbers to come, from `least` to as many as the text can still hold.
    std::size_t count(std::string_view what, long least);
    /// Consume `count` numbers.
    std::vector<double> reals(std::size_t count, std::string_view what);
    /// Consume `count` numbers, each larger than that before it.
    std::vector<double> ascending(std::size_t count, std::string_view what);

    /// An upper bound of the numbers that follow.
    [[nodiscard]] std::size_t most_left() const { return (rest_.size() + 1) / 2; }
    [[nodiscard]] InputError error(const std::string& problem) const { return {where_, problem}; }

  private:
    std::string_view word(std::string_view what);
    std::string_view rest_;
    SourceLocation where_;
};

}  // namespace lightwalk
