#pragma once
// A scene from files to a tracer, with the time each step took.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "apps/common_options.h"
#include "apps/walk_report.h"
#include "core/math/task_runner.h"
#include "core/problem_list.h"
#include "core/scene/scene.h"
#include "core/trace/tracer.h"
#include "io/ambient/ambient_store.h"
#include "io/scene/frozen_scene.h"
#include "parallel/concurrent_cache.h"
#include "parallel/published_cache.h"
#include "parallel/walk/cloud_frames.h"

namespace lightwalk {

class RankLink;

/// Stopwatch [s].
class Stopwatch {
  public:
    Stopwatch();
    [[nodiscard]] double seconds() const;

  private:
    std::int64_t start_ns_;
};

/// What it took to have a scene: time, and the most memory that the process held until then.
struct SceneCost {
    double read_seconds = 0, build_seconds = 0;
    std::uint64_t read_peak_bytes = 0, build_peak_bytes = 0;
};

struct SceneSession {
    /// Reads the description. Throws InputError for what cannot be read at all. `options`: after
    /// resolve_scene_files.
    /// @param shared_by  where another process of this machine shares the scene: what its share()
    ///                   returned; "": it is read
    SceneSession(const CommonOptions& options, WarningSink& warnings,
                 std::shared_ptr<FileRecorder> files = std::make_shared<FileRecorder>(),
                 const std::string& shared_by = {});
    /// From now on the scene is in memory that other processes can map: returns where; "" where the
    /// system has no such memory. Throws InputError as compile().
    [[nodiscard]] std::string share();
    /// Compiles the scene, by what `asked` says of its library. Throws InputError, with all
    /// problems of the description.
    void compile(Resources& asked);
    /// Compiles the scene, then the tracer. Throws InputError as compile().
    /// @param link  the other ranks, with which ambient values are exchanged; rank 0 alone has the
    ///              ambient file
    void build(const RenderSettings& settings, RankLink* link = nullptr);

    /// Of all that was read: the same on every machine for the same files.
    [[nodiscard]] std::string digest() const { return files->digest(); }

    /// Warn when nothing lights the scene; after build().
    void warn_of_darkness() const;

    [[nodiscard]] const Scene& scene() const { return *built; }
    [[nodiscard]] const Tracer& tracer() const { return *made; }

    WarningSink& warnings;
    std::shared_ptr<FileRecorder> files;
    LibraryPath library;
    std::unique_ptr<Resources> resources;      ///< the scene's library
    const FrozenScene* frozen = nullptr;       ///< where they are those of a frozen scene
    std::shared_ptr<const MemoryFile> shared;  ///< with other processes; null: nothing is
    int workers = 1;                           ///< that build the scene
    Ablation ablation;
    ProblemList problems;  ///< of the description, which `model` leaves out
    std::shared_ptr<const Model> model;
    std::unique_ptr<const Scene> built;
    // With -ab and -aa; they outlive the tracer.
    std::unique_ptr<ConcurrentCache> ambient;
    std::unique_ptr<AmbientStore> ambient_store;  ///< with -af
    std::unique_ptr<PublishedCache> freezable;
    std::vector<AmbientRecord> known;  ///< values that were in the ambient file
    std::unique_ptr<const Tracer> made;
    SceneCost cost;

  private:
    void read(const CommonOptions& options);
    void map(const std::string& path);
    void compile(Resources& asked, const TaskRunner& task_runner);
    void raise_problems(Resources& asked);
    void make_cache(const RenderSettings& settings, RankLink* link);
};

/// What `--stats` writes.
struct RunStatistics {
    std::string command;
    SceneCost scene;
    double render_seconds = 0;
    RayCounters rays;
    AmbientCounters ambient;
    std::size_t ambient_values = 0, ambient_bytes = 0;  ///< in the cache at the end
    int threads = 1;
    int width = 0, height = 0;  ///< of a picture; 0: no picture
    int frames = 0;
    int ranks = 1;
    WalkReport walk;                     ///< frames that reused others' points
    std::map<int, std::string> reports;  ///< of each rank (see rank_report); empty for one process
};
/// Write as JSON, whole or not at all. Throws InputError.
void write_statistics(const std::string& path, const RunStatistics& statistics);

}  // namespace lightwalk
