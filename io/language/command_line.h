#pragma once
// The part of the shell's grammar that scene commands use: words, quotes, pipes and sequences.
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files/file_source.h"

namespace lightwalk {

/// A command that cannot be run at all, or runs away; unlike a command that fails, it ends the
/// reading.
class CommandError : public InputError {
  public:
    using InputError::InputError;
};

/// The same for a command that may not be run, since it is not built in; scenes can be read on
/// without it.
class UnknownCommandError : public CommandError {
  public:
    /// `program`: the first one of the command that is not built in, or all of it.
    UnknownCommandError(const SourceLocation& where, const std::string& message,
                        std::string program)
        : CommandError(where, message), program_(std::move(program)) {}
    [[nodiscard]] const std::string& program() const { return program_; }

  private:
    std::string program_;
};

struct CommandWord {
    std::string text;
    bool pattern = false;  ///< holds an unquoted * ? or [: file names that match take its place
};
using SimpleCommand = std::vector<CommandWord>;  ///< a program and its arguments; never empty
using Pipeline = std::vector<SimpleCommand>;     ///< each one's output is the next one's input

/// Split a command as sh(1) does. Nothing when it needs a real shell: redirections, variables,
/// command substitution, conditions, groups, or a syntax error.
[[nodiscard]] std::optional<std::vector<Pipeline>> split_command(std::string_view text);

/// The words with patterns replaced by the names in `files` that match in `directory`, sorted; a
/// pattern without a match stays as it is.
[[nodiscard]] std::vector<std::string> expand_patterns(const SimpleCommand& command,
                                                       const std::string& directory,
                                                       FileSource& files);

/// The command without the '!' that it may begin with.
[[nodiscard]] std::string_view without_command_mark(std::string_view command);

/// The command for messages: its first line, shortened, with the '!'.
[[nodiscard]] std::string abbreviate_command(const std::string& command);

/// The word as the shell reads it back.
[[nodiscard]] std::string quoted_for_shell(std::string_view word);

}  // namespace lightwalk
