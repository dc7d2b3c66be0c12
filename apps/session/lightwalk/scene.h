#pragma once
// Scenes as a program that uses this library sees them: read, checked and compiled once, then
// rendered any number of times. Part of the public interface: no header of another library.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/ablation.h"
#include "core/error.h"
#include "core/math/vec3.h"

namespace lightwalk {

class CompiledScene;

/// Receives warnings; may be called from several threads, but never twice at once.
using TakeWarning = std::function<void(const std::string& message)>;

/// A primitive of a scene that is built in code: a material, a surface, a light source. Source:
/// "The Radiance 6.x Scene Description Language" (ray.pdf), whose types and arguments these are.
struct ScenePrimitive {
    std::string modifier = "void";     ///< name of a primitive that stands before it
    std::string type;                  ///< "plastic", "light", "polygon", "sphere", ...
    std::string name;                  ///< without white space
    std::vector<std::string> strings;  ///< its string arguments
    std::vector<double> numbers;       ///< its real arguments
};

/// Where a scene comes from: files, bytes in memory or primitives, one of the three.
struct SceneSource {
    /// Scene files in order, which may begin with one octree or frozen scene that the others add
    /// to. "-" is standard input.
    std::vector<std::string> files;
    /// The bytes of an octree, or the text of a scene file.
    std::string bytes;
    std::vector<ScenePrimitive> primitives;
    std::string name = "memory";  ///< how messages call what does not come from files

    std::vector<std::string> library;  ///< folders of function files and the like; empty: RAYPATH
    bool allow_commands = false;  ///< run commands in scene files that no built-in one replaces
    bool allow_stale = false;     ///< take a frozen scene whose files have changed since
    int threads = 0;              ///< that compile it; 0: one for each processor
    /// Give memory that is free after building back to the system. For programs whose process
    /// serves the renderer alone: it sets how the whole process allocates.
    bool trim_heap = false;
    Ablation ablation;  ///< changes the speed only: for tests and benchmarks
};

/// A scene that is ready to be rendered. Immutable: copies share it, and any number of renderers
/// and threads may use it at once. Several scenes can be open in one process.
class LoadedScene {
  public:
    /// Reads and compiles. Throws InputError (core/error.h), whose text has a line
    /// "file:line: what is wrong" for each problem of the scene.
    explicit LoadedScene(const SceneSource& source, TakeWarning warn = {});
    /// The same scene files, with all defaults.
    explicit LoadedScene(const std::vector<std::string>& files, TakeWarning warn = {});

    /// The box around all surfaces that are finite; empty where there are none: lower > upper [m].
    struct Box {
        Vec3 lower, upper;
    };
    [[nodiscard]] Box bounds() const;
    /// A digest of all that was read: equal for equal files.
    [[nodiscard]] std::string digest() const;

    /// What it is made of; for this project's own programs (apps/session/compiled_scene.h).
    [[nodiscard]] const std::shared_ptr<const CompiledScene>& compiled() const { return compiled_; }

  private:
    std::shared_ptr<const CompiledScene> compiled_;
};

/// Read a scene and write it, with all that rendering it needs, to one file that is mapped rather
/// than read. Throws InputError, also for a source that is but a frozen scene or does not consist
/// of files.
void freeze_scene(const SceneSource& source, const std::string& path, TakeWarning warn = {});

}  // namespace lightwalk
