#pragma once
// The words of a command line of which none stands for others.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

/// A cursor. Every mistake is a UsageError that names the option.
class ProgramWords {
  public:
    explicit ProgramWords(const std::vector<std::string>& words) : words_(words) {}

    [[nodiscard]] bool at_end() const { return at_ >= words_.size(); }
    /// Whether the next word begins with '-' and is more than that.
    [[nodiscard]] bool at_option() const;
    /// The next word, which is stepped over. There must be one.
    const std::string& take() { return words_[at_++]; }
    /// The words that are left.
    [[nodiscard]] std::vector<std::string> rest() const;

    /// The words up to here as a line of history behind the program's name.
    [[nodiscard]] std::string history(const std::string& program) const;

    // An argument of the option that take() has returned last; throw UsageError.
    const std::string& text(std::string_view what);
    double real(std::string_view what);
    int integer(std::string_view what, int least, int most);

    /// The last option is none of the program's.
    [[noreturn]] void unknown() const;
    /// The last option is one of Radiance's that is not covered.
    [[noreturn]] void refuse(const std::string& instead) const;

  private:
    [[nodiscard]] std::string option() const;

    const std::vector<std::string>& words_;
    std::size_t at_ = 0;
};

}  // namespace lightwalk
