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
    /// The same, with the output going to `sink`: by pieces where its last program writes them,
    /// else whole. Of a command that fails half way `sink` has had the pieces before.
    void run(const std::string& command, const std::string& directory, const SourceLocation& where,
             TextSink& sink);

  private:
    class Output;

    /// @param sink  may get the beginning of the output; null: all of it is returned
    [[nodiscard]] std::string run_to(const std::string& command, const std::string& directory,
                                     const SourceLocation& where, TextSink* sink);
    [[nodiscard]] std::string run_pipelines(const std::vector<Pipeline>& pipelines,
                                            const std::string& command,
                                            const std::string& directory,
                                            const SourceLocation& where, TextSink* sink);
    [[nodiscard]] std::string run_stage(const SimpleCommand& words, const std::string& command,
                                        const SourceLocation& where, GeneratorContext& context);
    [[nodiscard]] std::string run_program(const SimpleCommand& words, GeneratorContext& context);
    [[nodiscard]] std::string run_shell(const std::string& command, const std::string& directory,
                                        const SourceLocation& where);
    void charge(std::size_t bytes, const SourceLocation& where);
    void charge_piece(std::size_t bytes, const SourceLocation& where);

    LibraryPath library_;
    bool allow_commands_;
    WarningSink& warnings_;
    int depth_ = 0;
    std::size_t commands_ = 0, bytes_ = 0;
    std::size_t streamed_bytes_ = 0;  ///< of output that was never whole
};

}  // namespace lightwalk
