#pragma once
// Runs the `!` commands of scenes: by built-in generators, or by the shell if that is allowed.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/generators/generator.h"
#include "io/language/command_line.h"

namespace lightwalk {

/// Runs the commands of one scene, and limits their total number and output.
class CommandRunner {
  public:
    CommandRunner(LibraryPath library, bool allow_commands, WarningSink& warnings)
        : library_(std::move(library)), allow_commands_(allow_commands), warnings_(warnings) {}

    /// Run `command`, which may begin with '!', in `directory` ("" is the process's) with an empty
    /// standard input, and return its output. Throws FailedCommandError "bad status from ..." where
    /// a command fails: Radiance warns and goes on without a part of the scene. Throws
    /// UnknownCommandError for programs that are not built in (unless commands are allowed),
    /// CommandError for commands that nest too deep or write too much.
    [[nodiscard]] std::string run(const std::string& command, const std::string& directory,
                                  const SourceLocation& where);
    /// Run `command` and pass its output to `sink`: in parts if its last program writes so, else as
    /// a whole. If a command fails midway `sink` has received the parts before that.
    void run(const std::string& command, const std::string& directory, const SourceLocation& where,
             TextSink& sink);

    /// The output of the built-in generator args[0]. Unlike a command's failure an InputError is
    /// thrown.
    [[nodiscard]] std::string convert(const std::vector<std::string>& args,
                                      const std::string& directory);

    /// How many skies commands have made so far, also those within other commands.
    [[nodiscard]] std::size_t skies() const { return skies_; }

  private:
    class Output;

    /// Returns the output, without the beginning that `sink` has received; all of it if that is
    /// null.
    [[nodiscard]] std::string run_to(const std::string& command, const std::string& directory,
                                     const SourceLocation& where, TextSink* sink);
    [[nodiscard]] std::string run_pipelines(const std::vector<Pipeline>& pipelines,
                                            const std::string& command,
                                            const std::string& directory,
                                            const SourceLocation& where, TextSink* sink);
    [[nodiscard]] std::optional<std::string> model_scene(const std::string& path);
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
    std::size_t commands_ = 0, bytes_ = 0, skies_ = 0;
    std::size_t streamed_bytes_ = 0;  ///< length of all output that went to sinks in parts
};

}  // namespace lightwalk
