#pragma once
// Scenes from the command line: one octree, or scene files; commands by built-in generators.
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
    bool allow_commands = false;  ///< run commands that no generator replaces through the shell
    /// Working directory for scene files, commands and relative elements of `library`; "" is the
    /// process's.
    std::string directory = {};
    /// Lets generators that write much run beside the reading of what they write; null: one after
    /// the other.
    MakeTextPipe pipe = {};
};

/// Read a scene: `files` is one octree (frozen or not) or any number of scene files in order; "-"
/// is standard input, "!words" a command. Throws InputError "file:line: what is wrong". Warnings
/// follow Radiance's rules.
/// Commands that may not be run, unknown types and undefined modifiers do not end the reading: they
/// are gathered in `problems`, and the model is what is left; without `problems` they are thrown
/// together at the end. Names that a command may have defined, or a primitive of an unknown type,
/// are not complained of.
[[nodiscard]] std::shared_ptr<const Model> read_scene(std::span<const std::string> files,
                                                      const SceneReadOptions& options,
                                                      WarningSink& warnings,
                                                      ProblemList* problems = nullptr);

/// Parse scene text that is in memory, for tests and tools.
[[nodiscard]] std::shared_ptr<const Model> parse_scene(std::string_view text,
                                                       const std::string& name,
                                                       const SceneReadOptions& options,
                                                       WarningSink& warnings);

/// The model of an octree whose bytes are in memory; the scene files of one that is not frozen are
/// read.
[[nodiscard]] std::shared_ptr<const Model> read_octree(std::string_view bytes,
                                                       const std::string& name,
                                                       const SceneReadOptions& options,
                                                       WarningSink& warnings,
                                                       ProblemList* problems = nullptr);

}  // namespace lightwalk
