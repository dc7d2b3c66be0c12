#pragma once
// Tables of options, one row an option: command lines are read by them, and --help, -defaults and
// suggestions for misspelt options are printed from them.
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/math/vec3.h"
#include "io/options/option_words.h"

namespace lightwalk {

/// One of several words; see choice().
struct Choice {
    std::vector<std::string> words;
    std::function<void(std::size_t)> set;  ///< to a word, by its number
    std::function<std::size_t()> get;      ///< their count: none of them
};
/// An option without argument.
struct Action {
    std::function<void()> act;
};
/// An option with arguments of its own kind.
struct CustomOption {
    std::function<void(OptionWords&)> take;        ///< the option and its arguments
    std::function<std::string()> value = nullptr;  ///< as one would write it; null: there is none
};
/// An option whose argument is attached to its name.
struct AttachedOption {
    std::string name;
    std::function<bool(OptionWords&)> take;  ///< false: the word is another option after all
    std::function<std::string()> value = nullptr;
};
/// Radiance has it, or another command: all that is said is "option NAME" and why it is not there.
struct RefusedOption {
    std::string why;
};
/// No option, but the title of the rows behind it.
struct SectionTitle {
    std::string home = "";  ///< command whose help explains them, others' only names them; "": all
};

/// What a row's option sets. A variable must outlive the row; what it holds when help is printed is
/// the default. A bool is a switch where the row's words end with "[+-]" (it toggles, and sets with
/// + or - attached), else it is turned on.
using OptionPlace =
    std::variant<SectionTitle, bool*, int*, std::uint64_t*, float*, double*, Vec3*, Rgb*,
                 std::string*, Choice, Action, CustomOption, AttachedOption, RefusedOption>;

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();
inline constexpr double kPercent = 100;

/// What few rows need.
struct With {
    double least = -kUnlimited, most = kUnlimited;  ///< of a number, as it is written
    double divisor = 1;  ///< of a real number on its way into the variable; kPercent: a percentage
    const char* zero = nullptr;      ///< word for the integer 0, which is below `least`
    const char* expected = nullptr;  ///< in messages, in place of what follows from the limits
    const char* shown = nullptr;     ///< in help, in place of the variable's value
    const char* format = "%f";       ///< of -defaults for real numbers; %.0f: only whole ones
    std::function<std::string()> lines = nullptr;  ///< of -defaults, in place of the value's line
    /// Takes the option and its arguments in place of what its variable's type tells; false: it is
    /// another option.
    std::function<bool(OptionWords&)> take = nullptr;
    std::function<void()> then = nullptr;  ///< is called when the option was taken
    unsigned commands = ~0U;               ///< that take it: a sum of powers of two, one a command
    bool hidden = false;                   ///< neither help nor suggestions name it: for tests
};

struct OptionRow {
    std::string words;  ///< as help shows it: the name, then its arguments: "-vp X Y Z"; or a title
    OptionPlace place;
    /// What it does, understood without other lines. "COMMENT | TEXT": -defaults lists the option,
    /// with that comment; without a text it does for help, too.
    std::string text = "";
    With with = {};

    [[nodiscard]] std::string name() const;
    [[nodiscard]] bool attached() const;  ///< the argument is part of the option's word
    [[nodiscard]] bool offered() const;   ///< neither a title nor refused nor hidden
    [[nodiscard]] std::string comment() const;
    [[nodiscard]] std::string help() const;
    /// The arguments that set the present value, real numbers by this conversion of printf; "":
    /// there is no value.
    [[nodiscard]] std::string value(const char* format) const;
    [[nodiscard]] std::string default_text() const;  ///< as help shows it; "": none
};

/// One of several words, each for a value.
template <class Value>
Choice choice(Value& place,
              std::vector<std::pair<const char*, std::type_identity_t<Value>>> choices) {
    Choice result;
    for (const auto& choice : choices) result.words.emplace_back(choice.first);
    result.set = [&place, choices](std::size_t i) { place = choices[i].second; };
    result.get = [&place, choices] {
        std::size_t i = 0;
        while (i < choices.size() && choices[i].second != place) ++i;
        return i;
    };
    return result;
}

/// Throws UsageError: "option NAME: expected `expected`, found `found`".
[[noreturn]] void refuse_argument(const std::string& option, const std::string& expected,
                                  const std::string& found);

/// The options of one command.
class OptionTable {
  public:
    /// @param command    its name, and what stands for it in With::commands
    /// @param groups     of rows; those that the command takes remain, in order
    /// @param explained  options that its help explains though another command is their home
    OptionTable(std::pair<std::string, unsigned> command,
                const std::vector<std::vector<OptionRow>>& groups,
                std::vector<std::string> explained = {});

    /// Take the option in option position, if it is in the table; false leaves `words` as it is.
    /// Throws UsageError for wrong arguments.
    [[nodiscard]] bool take(OptionWords& words) const;
    /// The word in option position is no option: throws UsageError with the nearest name.
    [[noreturn]] void refuse(const OptionWords& words) const;

    /// What -defaults prints: a line an option, "name value", tabs, "# " and its comment.
    [[nodiscard]] std::string defaults() const;
    /// The options as --help prints them.
    [[nodiscard]] std::string help() const;
    [[nodiscard]] const std::string& command() const { return command_; }
    [[nodiscard]] const std::vector<OptionRow>& rows() const { return rows_; }

    std::shared_ptr<void> owner;  ///< keeps alive what the rows set, where nobody else does

  private:
    std::string command_;
    std::vector<OptionRow> rows_;
    std::vector<std::string> explained_;
};

/// A table that keeps what it sets.
template <class Command, class TableOf>
OptionTable owning_table(Command command, TableOf table_of) {
    const auto owner = std::make_shared<Command>(std::move(command));
    OptionTable table = table_of(*owner);
    table.owner = owner;
    return table;
}

/// A table in Markdown of the options of several commands; one that some take alike, with the same
/// default, stands once.
[[nodiscard]] std::string option_reference(const std::vector<OptionTable>& tables);

/// A line of -defaults: `left`, tabs to a common column, "# ", `comment`.
[[nodiscard]] std::string defaults_line(const std::string& left, const std::string& comment);

}  // namespace lightwalk
