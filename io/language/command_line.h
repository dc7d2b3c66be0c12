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

/// The error of a command that cannot be run, or exceeds a limit. It ends the reading of the scene.
class CommandError : public InputError {
  public:
    using InputError::InputError;
};

/// The error of a command that is not built in and may not be run. The rest of the scene can be
/// read without its output.
class UnknownCommandError : public CommandError {
  public:
    /// `program`: the first program of the command that is not built in, or the whole command when
    /// it cannot be divided.
    UnknownCommandError(const SourceLocation& where, const std::string& message,
                        std::string program)
        : CommandError(where, message), program_(std::move(program)) {}
    [[nodiscard]] const std::string& program() const { return program_; }

  private:
    std::string program_;
};

/// The error of a command that runs and fails, so that a part of the scene is missing. What else is
/// wrong with the scene can be told, too.
class FailedCommandError : public CommandError {
  public:
    using CommandError::CommandError;
};

struct CommandWord {
    std::string text;
    bool pattern = false;  ///< has an unquoted * ? or [: stands for the file names that match it
};
using SimpleCommand = std::vector<CommandWord>;  ///< a program and its arguments; never empty
using Pipeline = std::vector<SimpleCommand>;     ///< the output of each is the input of the next

/// Split a command into pipelines as sh(1) does. Nothing when it needs a real shell, which is the
/// case for redirections, variables, command substitution, conditions, groups, and syntax errors.
[[nodiscard]] std::optional<std::vector<Pipeline>> split_command(std::string_view text);

/// The words of a command, where each pattern is replaced by the sorted names of the files in
/// `directory` that match it; a pattern without a match stays as it is.
[[nodiscard]] std::vector<std::string> expand_patterns(const SimpleCommand& command,
                                                       const std::string& directory,
                                                       FileSource& files);

/// `command` without the '!' that it may begin with.
[[nodiscard]] std::string_view without_command_mark(std::string_view command);

/// `command` for messages: its first line, shortened, with the '!'.
[[nodiscard]] std::string abbreviate_command(const std::string& command);

/// `word` in quotes where the shell needs them to read it unchanged.
[[nodiscard]] std::string quoted_for_shell(std::string_view word);

}  // namespace lightwalk
