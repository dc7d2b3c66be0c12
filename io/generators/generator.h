#pragma once
// Built-in replacements of the programs that scene files call: they turn words into scene text.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/generators/text_sink.h"

namespace lightwalk {

/// What a generator may use.
struct GeneratorContext {
    const LibraryPath& library;
    std::string directory;  ///< working directory for relative file names; "" is the process's
    std::string input;      ///< standard input: what stands before the pipe
    bool has_input = false;
    WarningSink& warnings;
    /// Run a `!` command found in a file (xform, replmarks -e): returns its output. `directory` as
    /// above.
    std::function<std::string(const std::string& command, const std::string& directory)>
        run_command;
    /// Where a generator that writes much hands over what it has so far; null: it returns all.
    TextSink* output = nullptr;
};

/// Returns what it writes: what comes after that which went to context.output. args[0] is the
/// program's name. Throws InputError with the usage line for wrong arguments.
using Generator = std::string (*)(std::span<const std::string> args, GeneratorContext& context);

/// xform, genbox, gensurf, genrev, genworm, genprism, genblinds, gensky, gendaylit, replmarks; null
/// otherwise.
[[nodiscard]] Generator find_generator(const std::string& program);

/// Output is bounded so that hostile counts cannot exhaust memory; beyond it InputError is thrown.
inline constexpr std::size_t kMaxGeneratedBytes = std::size_t{512} << 20;
/// The same for output that goes to a sink, and is never whole.
inline constexpr std::size_t kMaxStreamedBytes = std::size_t{2} << 30;

// One function a program; each in its own file.
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

}  // namespace lightwalk
