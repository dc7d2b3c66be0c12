#pragma once
// Built-in replacements of the programs that scene files call: functions from words to scene text.
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/generators/text_sink.h"

namespace lightwalk {

/// The environment of a generator.
struct GeneratorContext {
    const LibraryPath& library;
    std::string directory;  ///< working directory for relative file names; "" is the process's
    std::string input;      ///< standard input: the output of the command before the pipe
    bool has_input = false;
    WarningSink& warnings;
    /// Runs a `!` command found in a file (xform, replmarks -e) in `directory`, and returns its
    /// output.
    std::function<std::string(const std::string& command, const std::string& directory)>
        run_command;
    /// The scene that an object or glTF file is; nothing for other names, and for all where it is
    /// null.
    std::function<std::optional<std::string>(const std::string& path)> model_scene = {};
    /// Receives the output of a generator that writes much, in parts; null: all is returned.
    TextSink* output = nullptr;
    /// Reads standard input once a generator asks for it; null: `input` holds it.
    std::function<std::string()> read_input = {};

    [[nodiscard]] const std::string& standard_input() {
        if (read_input) input = std::exchange(read_input, nullptr)();
        return input;
    }
};

/// A generator. It returns its output, without the beginning that it has passed to context.output.
/// args[0] is the program's name. Throws InputError with the usage line for wrong arguments.
using Generator = std::string (*)(std::span<const std::string> args, GeneratorContext& context);

/// The generator of this name: xform, genbox, gensurf, genrev, genworm, genprism, genblinds,
/// gensky, gendaylit, replmarks, ies2rad, ldt2rad, obj2rad or pkgBSDF. Null for other names.
[[nodiscard]] Generator find_generator(const std::string& program);

/// The largest output that is held in memory as a whole, so that hostile counts cannot exhaust it;
/// beyond it InputError is thrown.
inline constexpr std::size_t kMaxGeneratedBytes = std::size_t{512} << 20;
/// The largest output that goes to a sink in parts.
inline constexpr std::size_t kMaxStreamedBytes = std::size_t{2} << 30;

// One function for each program, each in a file of its own.
std::string run_xform(std::span<const std::string> args, GeneratorContext& context);
std::string run_genbox(std::span<const std::string> args, GeneratorContext& context);
std::string run_gensurf(std::span<const std::string> args, GeneratorContext& context);
std::string run_genrev(std::span<const std::string> args, GeneratorContext& context);
std::string run_genworm(std::span<const std::string> args, GeneratorContext& context);
std::string run_genprism(std::span<const std::string> args, GeneratorContext& context);
std::string run_genblinds(std::span<const std::string> args, GeneratorContext& context);
std::string run_gensky(std::span<const std::string> args, GeneratorContext& context);
std::string run_gendaylit(std::span<const std::string> args, GeneratorContext& context);
std::string run_replmarks(std::span<const std::string> args, GeneratorContext& context);
std::string run_obj2rad(std::span<const std::string> args, GeneratorContext& context);
// Both keep the files that they make in the context's source of files (FileSource::keep).
std::string run_ies2rad(std::span<const std::string> args, GeneratorContext& context);
std::string run_ldt2rad(std::span<const std::string> args, GeneratorContext& context);
std::string run_pkgbsdf(std::span<const std::string> args, GeneratorContext& context);

}  // namespace lightwalk
