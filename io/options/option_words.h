#pragma once
// The words of a command line, read from left to right as Radiance's programs read them.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/rgb.h"
#include "io/files/file_source.h"

namespace lightwalk {

/// A command line that cannot be understood. Programs print it and exit with 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Walks over the words. A word in option position is expanded first: `@file` stands for the
/// white-space separated words of the file, `$NAME` for those of the environment variable, again
/// and again until the word begins with neither. There are no quotes and no comments. Source:
/// Radiance manual page rtrace(1).
class OptionWords {
  public:
    explicit OptionWords(std::vector<std::string> words,
                         std::shared_ptr<FileSource> files = real_files());

    /// Expand the word in option position; false at the end. Throws UsageError for a file or
    /// variable that is missing, too long (4095 words), or that includes itself.
    [[nodiscard]] bool at_option();
    /// The word in option position; only after at_option() said true.
    [[nodiscard]] const std::string& option() const { return words_[at_].text; }
    /// Words from the option on, the option included.
    [[nodiscard]] std::vector<std::string> rest() const;
    /// Step over `count` words.
    void skip(std::size_t count);

    // The option's arguments, one after the other. The first call steps over the option itself. All
    // throw UsageError naming the option, what was found and what was expected.
    [[nodiscard]] std::string text();
    [[nodiscard]] double real();
    [[nodiscard]] int integer();
    [[nodiscard]] std::uint64_t unsigned_integer();
    [[nodiscard]] Rgb rgb();  ///< three reals

    /// Value of the switch `name` that stands in option position: bare toggles `current`, + or 1
    /// attached is on, - or 0 is off. Nothing when the word is another option. Steps over it.
    [[nodiscard]] std::optional<bool> toggle(std::string_view name, bool current);

    /// Position of the next word, and all words so far with their expansions, for history lines.
    [[nodiscard]] std::size_t position() const { return at_; }
    [[nodiscard]] std::vector<std::string> expanded() const;

  private:
    struct Word {
        std::string text;
        int source = -1;  ///< into sources_: where it was expanded from
    };
    struct Source {
        std::string name;  ///< "@file" or "$NAME"
        int parent = -1;
    };
    [[nodiscard]] std::string argument(std::string_view expected);
    void expand();

    std::shared_ptr<FileSource> files_;
    std::vector<Word> words_;
    std::vector<Source> sources_;
    std::size_t at_ = 0;
    std::string current_;  ///< option whose arguments are being read; empty before the first one
};

/// The entry of `names` that `word` is probably a misspelling of; nothing when none is near.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word,
                                                      std::span<const std::string> names);

/// The words as one history line of an information header: words that are empty or hold blanks or
/// quotes inside are quoted.
[[nodiscard]] std::string history_line(std::span<const std::string> words);

}  // namespace lightwalk
