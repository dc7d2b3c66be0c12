#pragma once
// Reads the words of a generator's command line from left to right.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lightwalk {

/// A cursor over the words. Every mistake is an InputError "PROGRAM: what is wrong; usage: PROGRAM
/// ...".
class GeneratorWords {
  public:
    /// `usage` is the usage line without the program's name. Both arguments must outlive the
    /// object.
    GeneratorWords(std::span<const std::string> args, std::string_view usage)
        : args_(args), usage_(usage) {}

    [[nodiscard]] bool at_end() const { return at_ >= args_.size(); }
    [[nodiscard]] std::size_t left() const { return args_.size() - at_; }
    [[nodiscard]] const std::string& program() const { return args_[0]; }
    [[nodiscard]] std::span<const std::string> all() const { return args_; }
    /// The next word, without consuming it. There must be one.
    [[nodiscard]] const std::string& peek() const { return args_[at_]; }

    /// Consume a word; `what` is its name in messages.
    const std::string& text(std::string_view what);
    /// Consume a number of the scene language.
    double real(std::string_view what);
    double positive(std::string_view what);
    /// Consume an integer from `least` to `most`.
    long integer(std::string_view what, long least, long most);
    /// Consume the next word if it is `word`.
    bool accept(std::string_view word);

    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void unknown_option() const;  ///< fail because the next word is no option

  private:
    std::span<const std::string> args_;
    std::string_view usage_;
    std::size_t at_ = 1;
};

}  // namespace lightwalk
