#include "io/scene/command_runner.h"

#include <exception>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "io/generators/sky_command.h"
#include "io/scene/model_scene.h"

namespace lightwalk {
namespace {

constexpr int kMaxDepth = 64;
/// A scene's commands together, nested ones included.
constexpr std::size_t kMaxCommands = std::size_t{1} << 20;
constexpr std::size_t kMaxBytes = 2 * kMaxGeneratedBytes;

/// cat(1): its files, or its input, one after the other.
std::string run_cat(std::span<const std::string> args, GeneratorContext& context) {
    if (args.size() < 2) return context.input;
    std::string output;
    for (const std::string& name : args.subspan(1)) {
        if (name.size() > 1 && name[0] == '-') throw InputError("usage: cat [file ...]");
        if (name == "-") {
            output += context.input;
        } else {
            const std::string path = path_from(context.directory, name);
            FileSource& files = context.library.files();
            if (!files.readable(path)) throw InputError("cat: cannot open " + path);
            output += files.read(path, kMaxGeneratedBytes);
        }
        if (output.size() > kMaxGeneratedBytes) throw InputError("cat: too much output");
    }
    return output;
}

Generator find_program(const std::string& name) {
    return name == "cat" ? &run_cat : find_generator(name);
}

/// The first program that is not built in; nothing when all are.
std::optional<std::string> unknown_program(const std::vector<Pipeline>& pipelines) {
    for (const Pipeline& pipeline : pipelines) {
        for (const SimpleCommand& command : pipeline) {
            if (find_program(command[0].text) == nullptr) return command[0].text;
        }
    }
    return std::nullopt;
}

struct DepthGuard {
    explicit DepthGuard(int& value) : depth(value) { ++depth; }
    ~DepthGuard() { --depth; }
    DepthGuard(const DepthGuard&) = delete;
    DepthGuard& operator=(const DepthGuard&) = delete;
    int& depth;
};

}  // namespace

/// Passes on the pieces that a program writes. An exception of who takes them is not the program's:
/// it becomes a Stop while it goes through the program, and then itself again.
class CommandRunner::Output final : public TextSink {
  public:
    struct Stop {};

    Output(CommandRunner& runner, const SourceLocation& where, TextSink& sink)
        : runner_(runner), where_(where), sink_(sink) {}

    void push(std::string_view piece) override {
        try {
            runner_.charge_piece(piece.size(), where_);
            sink_.push(piece);
        } catch (...) {
            error_ = std::current_exception();
            throw Stop();
        }
    }
    [[noreturn]] void rethrow() const { std::rethrow_exception(error_); }

  private:
    CommandRunner& runner_;
    const SourceLocation& where_;
    TextSink& sink_;
    std::exception_ptr error_;
};

void CommandRunner::charge_piece(std::size_t bytes, const SourceLocation& where) {
    if (bytes > kMaxStreamedBytes - streamed_bytes_)
        throw CommandError(where, "the scene's commands write too much");
    streamed_bytes_ += bytes;
}

void CommandRunner::charge(std::size_t bytes, const SourceLocation& where) {
    if (bytes > kMaxBytes - bytes_)
        throw CommandError(where, "the scene's commands write too much");
    bytes_ += bytes;
}

std::string CommandRunner::run(const std::string& command, const std::string& directory,
                               const SourceLocation& where) {
    return run_to(command, directory, where, nullptr);
}

void CommandRunner::run(const std::string& command, const std::string& directory,
                        const SourceLocation& where, TextSink& sink) {
    sink.push(run_to(command, directory, where, &sink));
}

std::string CommandRunner::convert(const std::vector<std::string>& args,
                                   const std::string& directory) {
    const LibraryPath library = library_.relative_to(directory);
    GeneratorContext context{library, directory, {}, false, warnings_, {}};
    std::string output = find_generator(args[0])(args, context);
    charge(output.size(), {args.back(), 0});
    return output;
}

std::string CommandRunner::run_to(const std::string& command, const std::string& directory,
                                  const SourceLocation& where, TextSink* sink) {
    const DepthGuard guard(depth_);
    if (depth_ > kMaxDepth) {
        throw CommandError(where, "commands nest more than " + std::to_string(kMaxDepth) +
                                      " levels deep at \"" + abbreviate_command(command) +
                                      "\": does a file read itself?");
    }
    if (++commands_ > kMaxCommands) throw CommandError(where, "the scene has too many commands");
    const std::optional<std::vector<Pipeline>> pipelines =
        split_command(without_command_mark(command));
    std::string output;
    if (pipelines && !unknown_program(*pipelines)) {
        output = run_pipelines(*pipelines, command, directory, where, sink);
    } else if (allow_commands_) {
        output = run_shell(std::string(without_command_mark(command)), directory, where);
    } else if (pipelines) {
        const std::string program = *unknown_program(*pipelines);
        throw UnknownCommandError(
            where,
            "command \"" + program +
                "\" is not built in; --allow-commands runs it through the shell",
            program);
    } else {
        const std::string shown = abbreviate_command(command);
        throw UnknownCommandError(
            where, "\"" + shown + "\" needs a shell; --allow-commands runs it through one", shown);
    }
    charge(output.size(), where);
    return output;
}

std::string CommandRunner::run_pipelines(const std::vector<Pipeline>& pipelines,
                                         const std::string& command, const std::string& directory,
                                         const SourceLocation& where, TextSink* sink) {
    const LibraryPath library = library_.relative_to(directory);
    // The outputs of several pipelines may form one primitive, so they are passed on together.
    std::optional<Output> pieces;
    if (sink != nullptr && pipelines.size() == 1) pieces.emplace(*this, where, *sink);
    std::string output;
    for (const Pipeline& pipeline : pipelines) {
        GeneratorContext context{library, directory, {}, false, warnings_, {}};
        context.run_command = [this, &where](const std::string& nested, const std::string& from) {
            return run(nested, from, where);
        };
        context.model_scene = [this](const std::string& path) { return model_scene(path); };
        for (const SimpleCommand& words : pipeline) {
            if (pieces && &words == &pipeline.back()) context.output = &*pieces;
            std::string written;
            try {
                written = run_stage(words, command, where, context);
            } catch (const Output::Stop&) {
                pieces->rethrow();
            }
            charge(written.size(), where);
            context.input = std::move(written);
            context.has_input = true;
        }
        output += context.input;
    }
    return output;
}

/// What a command reads does not know what the scene has defined by then: it brings its materials.
std::optional<std::string> CommandRunner::model_scene(const std::string& path) {
    if (!is_model_name(path)) return std::nullopt;
    const std::string here = library_.base().empty() ? std::string() : library_.base() + "/";
    const std::string shown = path.starts_with(here) ? path.substr(here.size()) : path;
    return read_model(shown, path, library_.files(), nullptr, warnings_);
}

/// One program of a pipeline.
std::string CommandRunner::run_stage(const SimpleCommand& words, const std::string& command,
                                     const SourceLocation& where, GeneratorContext& context) {
    try {
        return run_program(words, context);
    } catch (const CommandError& error) {
        const std::string prefix = to_prefix(where);
        if (std::string_view(error.what()).starts_with(prefix)) throw;
        throw CommandError(where, error.what());
    } catch (const InputError& error) {
        throw FailedCommandError(
            where, "bad status from \"" + abbreviate_command(command) + "\": " + error.what());
    }
}

std::string CommandRunner::run_program(const SimpleCommand& words, GeneratorContext& context) {
    const std::vector<std::string> args =
        expand_patterns(words, context.directory, library_.files());
    if (SkyCommand::is_sky(args[0])) ++skies_;
    return find_program(args[0])(args, context);
}

std::string CommandRunner::run_shell(const std::string& command, const std::string& directory,
                                     const SourceLocation& where) {
    std::string script = "exec </dev/null\n";
    if (!directory.empty()) script += "cd -- " + quoted_for_shell(directory) + " || exit 1\n";
    script += command;
    std::optional<std::string> output =
        library_.files().answer(FileSource::Question::script, script, kMaxGeneratedBytes);
    if (!output) throw CommandError(where, "cannot start the shell");
    const bool good = output->front() == '0';
    output->erase(0, 1);
    if (output->size() > kMaxGeneratedBytes) {
        throw CommandError(where, "\"" + abbreviate_command(command) + "\" writes too much");
    }
    if (!good)
        throw FailedCommandError(where, "bad status from \"" + abbreviate_command(command) + "\"");
    return *std::move(output);
}

}  // namespace lightwalk
