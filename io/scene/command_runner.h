#pragma once
// Runs the `!` commands of scenes: by built-in generators, or through the shell where that is
// allowed.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/generators/generator.h"
#include "io/language/command_line.h"

namespace lightwalk {

/// One for each scene that is read: it bounds what all its commands together may do.
class CommandRunner {
  public:
    CommandRunner(LibraryPath library, bool allow_commands, WarningSink& warnings)
        : library_(std::move(library)), allow_commands_(allow_commands), warnings_(warnings) {}

    /// Output of `command`, which may begin with '!', run in `directory` ("" is the process's) with
    /// an empty standard input. A command that fails gives the warning "bad status from ..."; what
    /// it wrote is kept. Throws UnknownCommandError for programs that are not built in (unless
    /// commands are allowed), CommandError for commands that nest without end or write too much.
    [[nodiscard]] std::string run(const std::string& command, const std::string& directory,
                                  const SourceLocation& where);

  private:
    [[nodiscard]] std::string run_pipelines(const std::vector<Pipeline>& pipelines,
                                            const std::string& command,
                                            const std::string& directory,
                                            const SourceLocation& where);
    [[nodiscard]] std::string run_program(const SimpleCommand& words, GeneratorContext& context);
    [[nodiscard]] std::string run_shell(const std::string& command, const std::string& directory,
                                        const SourceLocation& where);
    void charge(std::size_t bytes, const SourceLocation& where);

    LibraryPath library_;
    bool allow_commands_;
    WarningSink& warnings_;
    int depth_ = 0;
    std::size_t commands_ = 0, bytes_ = 0;
};

}  // namespace lightwalk
