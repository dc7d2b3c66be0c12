#pragma once
// Reads scenes: an octree, scene files, whose commands run as built-in generators, or files that
// are added to an octree.
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/model/primitive.h"
#include "core/problem_list.h"
#include "io/files/library_path.h"
#include "io/generators/text_sink.h"

namespace lightwalk {

struct SceneReadOptions {
    LibraryPath library = LibraryPath::from_environment();
    bool allow_commands = false;  ///< run commands that are not built in through the shell
    /// Working directory of scene files, commands and relative elements of `library`; "" is the
    /// process's.
    std::string directory = {};
    /// Makes pipes by which generators that write much run concurrently with the parsing of their
    /// output; null: output is parsed on the generator's thread.
    MakeTextPipe pipe = {};
    /// What scene files are added to, as to an octree; null: nothing.
    std::shared_ptr<const Model> base = {};
};

/// What is wrong with an octree or frozen scene that does not come first.
inline constexpr const char* kOneBase =
    "a scene is built on one octree or frozen scene, which is named before the scene files";

/// Read a scene. `files` is one octree (frozen or not), any number of scene files in order, or
/// both: the octree, then files that add to it, and use and redefine its modifiers by their names.
/// "-" is standard input and "!words" a command. Throws InputError "file:line: what is wrong".
/// Warnings follow Radiance's rules. Commands that may not be run, unknown types and undefined
/// modifiers do not end the reading: they are collected in `problems`, and the model is made of the
/// rest; without `problems` they are thrown together at the end. Undefined names that a skipped
/// command or a primitive of an unknown type may have defined are not reported.
[[nodiscard]] std::shared_ptr<const Model> read_scene(std::span<const std::string> files,
                                                      const SceneReadOptions& options,
                                                      WarningSink& warnings,
                                                      ProblemList* problems = nullptr);

/// Parse scene text in memory, for tests and tools.
[[nodiscard]] std::shared_ptr<const Model> parse_scene(std::string_view text,
                                                       const std::string& name,
                                                       const SceneReadOptions& options,
                                                       WarningSink& warnings);

/// The model of an octree in memory; if it is not frozen its scene files are read.
[[nodiscard]] std::shared_ptr<const Model> read_octree(std::string_view bytes,
                                                       const std::string& name,
                                                       const SceneReadOptions& options,
                                                       WarningSink& warnings,
                                                       ProblemList* problems = nullptr);

}  // namespace lightwalk
