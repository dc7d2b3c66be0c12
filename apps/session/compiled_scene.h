#pragma once
// A scene, from where it is described to what rays can be cast in.
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "apps/session/lightwalk/scene.h"
#include "core/error.h"
#include "core/math/task_runner.h"
#include "core/model/model_difference.h"
#include "core/model/resources.h"
#include "core/problem_list.h"
#include "core/scene/scene.h"
#include "io/files/file_source.h"
#include "io/files/library_path.h"
#include "io/files/memory_file.h"
#include "io/scene/frozen_scene.h"

namespace lightwalk {

class LightMemo;

/// What it took to have a scene: time, and the most memory that the process held until then.
struct SceneCost {
    double read_seconds = 0, build_seconds = 0;
    std::uint64_t read_peak_bytes = 0, build_peak_bytes = 0;
};

/// Largest memory this process ever held [bytes].
[[nodiscard]] std::uint64_t peak_memory_bytes();

/// Warnings as a function gets them. Callable from many threads.
class CallbackWarnings final : public WarningSink {
  public:
    explicit CallbackWarnings(TakeWarning take) : take_(std::move(take)) {}
    void warn(const std::string& message) override;

  private:
    TakeWarning take_;
    std::mutex mutex_;
};

/// Reads when it is made; compile() does the rest. For one thread until it is compiled.
class CompiledScene {
  public:
    /// Throws InputError for what cannot be read at all.
    /// @param warnings   of reading, and of compiling; must outlive this
    /// @param files      where all that is read comes from
    /// @param shared_by  where another process of this machine shares the scene: what its share()
    ///                   returned; "": it is read
    CompiledScene(const SceneSource& source, WarningSink& warnings,
                  std::shared_ptr<FileRecorder> files = std::make_shared<FileRecorder>(),
                  const std::string& shared_by = {});

    /// A scene of the same surfaces under other modifiers and sources, compiled; nothing is read.
    /// It shares what it can with `base` (Scene), and is built as a whole where it cannot. Throws
    /// InputError for bad modifiers.
    /// @param base      after compile(); is kept alive
    /// @param change    of base->model()
    /// @param warnings  of what is compiled; must outlive this
    CompiledScene(const std::shared_ptr<const CompiledScene>& base, const ModelChange& change,
                  WarningSink& warnings);

    /// Compiles, by what the scene's library says. Throws InputError, with all problems of the
    /// description.
    void compile() { compile(*resources_); }
    /// Compiles by what `asked` says of the library.
    void compile(Resources& asked);
    /// Before compile(): what differs from another reading of the same files. The modifiers that
    /// both have get the indices that they have there, where that is possible. Throws InputError,
    /// with all problems of the description.
    /// @param before  after compile()
    [[nodiscard]] ModelDifference compare_with(const CompiledScene& before);
    /// In place of compile(), where compare_with(*before) finds the same geometry: shares what it
    /// can with it. Throws InputError; GeometryChange where the modifiers make it another one.
    void compile_on(const std::shared_ptr<const CompiledScene>& before);
    /// From now on the scene is in memory that other processes can map: returns where; "" where the
    /// system has no such memory. Before compile(); throws InputError as that does.
    [[nodiscard]] std::string share();

    /// As it was read.
    [[nodiscard]] const Model& model() const { return *model_; }
    /// After compile().
    [[nodiscard]] const Scene& scene() const { return *scene_; }
    /// Where its files are looked for.
    [[nodiscard]] const LibraryPath& library() const { return library_; }
    [[nodiscard]] Resources& resources() { return *resources_; }
    /// The frozen scene on which the scene is built; null: there is none.
    [[nodiscard]] const FrozenScene* frozen() const { return frozen_; }
    /// Whether a frozen scene is all of it.
    [[nodiscard]] bool is_frozen() const { return frozen_ != nullptr && !extended_; }
    [[nodiscard]] const FileRecorder& files() const { return *files_; }
    [[nodiscard]] int threads() const { return threads_; }
    [[nodiscard]] const SceneCost& cost() const { return cost_; }
    [[nodiscard]] WarningSink& warnings() const { return warnings_; }
    /// What is known of its light sources from before, and where it is kept; null: nowhere.
    [[nodiscard]] LightMemo* light_memo() const { return light_memo_.get(); }
    void set_light_memo(std::shared_ptr<LightMemo> memo) { light_memo_ = std::move(memo); }

  private:
    void read(const SceneSource& source);
    void read_files(const SceneSource& source, std::unique_ptr<FrozenScene> base);
    void read_bytes(const SceneSource& source);
    void map_bytes(const SceneSource& source);
    void adopt(std::unique_ptr<FrozenScene> opened);
    void map_shared(const std::string& path);
    void trim_heap() const;

    std::shared_ptr<const CompiledScene> base_;  ///< that this is a change of; null: it is none
    WarningSink& warnings_;
    std::shared_ptr<FileRecorder> files_;
    LibraryPath library_;
    int threads_;
    bool trim_heap_;
    Ablation ablation_;
    std::shared_ptr<Resources> resources_;
    const FrozenScene* frozen_ = nullptr;       ///< which resources_ keep
    bool extended_ = false;                     ///< files were added to it
    std::shared_ptr<const MemoryFile> shared_;  ///< with other processes; null: nothing is
    ProblemList problems_;                      ///< of the description, which model_ leaves out
    std::shared_ptr<const Model> model_;
    SurfaceKeys keys_;            ///< of its surfaces
    bool sources_moved_ = false;  ///< model_ has its sources elsewhere than the scene it shares
    std::shared_ptr<const Scene> scene_;
    std::shared_ptr<LightMemo> light_memo_;
    SceneCost cost_;
};

/// A scene that keeps whom it warns. Parameters and errors as those of CompiledScene.
[[nodiscard]] std::shared_ptr<CompiledScene> read_compiled_scene(
    const SceneSource& source, TakeWarning warn,
    std::shared_ptr<FileRecorder> files = std::make_shared<FileRecorder>(),
    const std::string& shared_by = {});

}  // namespace lightwalk
