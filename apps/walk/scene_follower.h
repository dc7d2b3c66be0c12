#pragma once
// Follows the files of a walk's scene: reads them again when they are edited, beside the frames
// that go on.
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "apps/session/compiled_scene.h"
#include "core/model/model_difference.h"
#include "io/files/watched_files.h"

namespace lightwalk {

/// What has become of edited files.
struct SceneNews {
    std::vector<std::string> files;  ///< that are others than when the scene was loaded
    /// The scene that they describe now, compiled, and what differs from the one that was loaded.
    /// Null: it is the same one, or cannot be read.
    std::shared_ptr<const CompiledScene> scene;
    ModelDifference difference;
    bool all_differs = false;  ///< whatever the difference says, as in a file that is placed
    std::vector<std::string> problems;  ///< why it cannot be read, "file:line: ..."
    /// The walk has to begin anew: a file is another one that says how to render, or there is no
    /// memory for two of its scenes.
    bool begins_anew = false;
};

/// A scene as it was loaded, with what has to be known to read it again.
struct LoadedFiles {
    SceneSource source;
    TakeWarning warn;
    std::shared_ptr<const CompiledScene> scene;  ///< after compile()
    std::shared_ptr<WatchedFiles> files;         ///< that it was read from
    std::set<std::string> texts;  ///< those of them that describe it; others are pictures and such
};

/// Looks at the files twice a second, on a thread of its own, which reads them when they have
/// settled (SettledFiles). At most one scene is read that is not loaded yet, and no more than half
/// of the time is spent reading. Dates and sizes are looked at: it works on all file systems.
class SceneFollower {
  public:
    explicit SceneFollower(LoadedFiles loaded);
    /// Waits for what is being read.
    ~SceneFollower();
    SceneFollower(const SceneFollower&) = delete;
    SceneFollower& operator=(const SceneFollower&) = delete;

    /// What is new, once; then settle() says what became of it. Does not wait.
    [[nodiscard]] std::optional<SceneNews> take();
    /// @param loaded  whether the news' scene is the walk's from now on
    void settle(bool loaded);

  private:
    void run();
    /// False: the end is near.
    [[nodiscard]] bool pause(std::chrono::milliseconds time);
    void read_anew();
    [[nodiscard]] std::shared_ptr<CompiledScene> read(const std::shared_ptr<WatchedFiles>& files,
                                                      SceneNews& news, LoadedFiles& next);
    /// Waits until it has become of it what may.
    void tell(SceneNews news, LoadedFiles next);

    LoadedFiles loaded_;
    FileStates loaded_states_;             ///< of its files when it was read
    std::shared_ptr<WatchedFiles> watch_;  ///< that were read last, with success or without
    bool failed_ = false;                  ///< they could not be read

    std::mutex mutex_;
    std::condition_variable changed_;
    // Under the mutex.
    bool ends_ = false;
    std::optional<SceneNews> news_;
    std::optional<bool> settled_;
    std::thread thread_;
};

}  // namespace lightwalk
