#pragma once
// What does a renderer's work: the threads of this process, or ranks that share it.
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "apps/session/compiled_scene.h"
#include "apps/session/lightwalk/renderer.h"
#include "apps/session/progress_reporter.h"
#include "apps/session/run_statistics.h"
#include "apps/session/scene_session.h"
#include "core/math/function_ref.h"
#include "core/trace/ray_tally.h"
#include "core/view/view.h"
#include "parallel/adaptive_picture.h"
#include "parallel/cache_prepass.h"
#include "parallel/executor.h"
#include "parallel/frame.h"
#include "parallel/frame_options.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/live_frames.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// A picture that is wanted, with all that its options refer to.
struct PictureRequest {
    /// @param before  the view of the frame before, for motion blur; null or unusable: none
    PictureRequest(const View& view, const View* before, const FrameOptions& wanted)
        : camera(view), options(wanted) {
        if (before != nullptr && !Camera::problem(*before)) previous.emplace(*before);
        options.previous = previous ? &*previous : nullptr;
    }
    /// A pass over the picture of a request.
    PictureRequest(const PictureRequest& picture, const SamplePass& pass, bool is_first)
        : PictureRequest(picture.camera.view(),
                         picture.previous ? &picture.previous->view() : nullptr, picture.options) {
        tiles = pass.tiles;
        first = is_first;
        options.tiles = &*tiles;
        options.pixels.samples = pass.samples;
        options.seed = pass.seed;
    }
    PictureRequest(const PictureRequest&) = delete;
    PictureRequest& operator=(const PictureRequest&) = delete;

    Camera camera;
    std::optional<Camera> previous;
    FrameOptions options;
    std::shared_ptr<CheckpointSink> checkpoint;  ///< null: none
    std::optional<TileMask> tiles;               ///< of a pass; nothing: the whole picture
    bool first = true;                           ///< of the passes of its picture
};

class RenderBackend {
  public:
    /// Throws InputError.
    /// @param scene  after compile()
    /// @param leads  whether this process is the one that keeps the ambient file
    RenderBackend(std::shared_ptr<const CompiledScene> scene, RendererOptions options, bool leads);
    virtual ~RenderBackend() = default;
    RenderBackend(const RenderBackend&) = delete;
    RenderBackend& operator=(const RenderBackend&) = delete;

    [[nodiscard]] const RendererOptions& options() const { return options_; }
    /// Until the scene is changed.
    [[nodiscard]] const SceneSession& session() const { return *session_; }
    /// From now on the scene is this one, and has a session of its own: its
    /// cache of indirect light is empty, and frames() go on where they were. Nothing of what
    /// session() returned before is used any more, or may be. Throws InputError, and leaves all as
    /// it was.
    /// @param scene  a change of session().compiled(), or another scene after compile()
    virtual void change(const std::shared_ptr<const CompiledScene>& scene);
    /// The same, for a change of session().compiled().model(). On ranks it is called on rank 0 and
    /// while run() is, and changes the scene of all ranks, or of none.
    virtual void change_model(const ModelChange& change);
    /// Null: pictures have no layers.
    [[nodiscard]] const LightGroups* light_groups() const { return contexts_.light_groups(); }
    /// Of pictures of a size; a walk that is steered traces every pixel.
    [[nodiscard]] FrameOptions frame_options(int width, int height) const;
    /// Requested: ends what is under way.
    [[nodiscard]] StopFlag& stop() { return options_.stop != nullptr ? *options_.stop : own_stop_; }
    /// What was reported last.
    [[nodiscard]] RenderProgress progress() const;

    /// See Renderer::run.
    virtual void run(FunctionRef<void()> lead) { lead(); }
    /// Whether this process gives out the work.
    [[nodiscard]] virtual bool leads() const { return true; }

    // Where this process leads. Tasks are finished in the order in which they were begun; nothing:
    // stopped.

    /// Others may work on it from now on.
    virtual void begin(const PictureRequest& /*request*/) {}
    virtual void begin(const RayTask& /*list*/) {}
    [[nodiscard]] virtual std::optional<Frame> finish(const PictureRequest& request) = 0;
    /// The records of the rays, one after the other.
    [[nodiscard]] virtual std::optional<std::string> finish(const RayTask& list) = 0;
    /// See Renderer.
    [[nodiscard]] virtual std::size_t pictures_ahead() const { return 1; }
    /// @param begun  whether a list was begun that is not finished
    [[nodiscard]] virtual RayDemand ray_demand(bool wait, bool begun) = 0;
    [[nodiscard]] virtual LiveFrames& frames() = 0;
    /// What the work has taken so far; on ranks, after run(), that of all of them.
    [[nodiscard]] virtual RunStatistics statistics() const;

  protected:
    /// Whom makers of pictures tell.
    [[nodiscard]] ProgressListener listener();
    /// How the cache of indirect light is filled before a picture.
    [[nodiscard]] CachePrepass prepass() const;
    /// The next frame of a walk, drawn from the points of those before it; one of another size
    /// starts anew.
    /// @param workers  that draw it, for estimates of the time it takes
    [[nodiscard]] std::optional<Frame> draw_frame(const PictureRequest& request, int workers);
    /// Draws one pass over a picture, and tells how far it is; nothing: stopped.
    using DrawPass =
        FunctionRef<std::optional<Frame>(const PictureRequest& pass, TakeProgress progress)>;
    /// Passes until the goal is reached, or the time is up.
    [[nodiscard]] std::optional<Frame> draw_until_good(const PictureRequest& request,
                                                       DrawPass draw);
    /// Before a frame of a walk, the first one of its size or a later one. False: stopped.
    [[nodiscard]] virtual bool prepare(const PictureRequest& /*request*/, bool /*first*/) {
        return true;
    }
    /// A scene that is to take the place of the one at hand, and what goes with it.
    struct ChangedScene {
        std::unique_ptr<SceneSession> session;
        std::unique_ptr<const Tracer> direct;       ///< see make_direct
        std::shared_ptr<const LightGroups> groups;  ///< see find_groups
    };
    /// Throws InputError.
    [[nodiscard]] ChangedScene make_changed(const std::shared_ptr<const CompiledScene>& scene);
    /// The session's scene under a change.
    [[nodiscard]] std::shared_ptr<const CompiledScene> changed_scene(
        const ModelChange& change) const;
    /// Exchanges it for the one at hand. Nothing may use that one any more but frames(), which
    /// change here.
    /// @param frames  null: none are made yet
    void take_over(ChangedScene& next, LiveFrames* frames);
    /// Without indirect light, of walks that are steered; null: there is none anyway.
    [[nodiscard]] std::unique_ptr<const Tracer> make_direct(const SceneSession& session,
                                                            WarningSink& warnings) const;
    /// Null where no groups are asked for.
    [[nodiscard]] std::shared_ptr<const LightGroups> find_groups(const SceneSession& session) const;
    /// Appends the record of a finished ray to `bytes`.
    void record(int worker, const RayQuery& query, const Ray& ray, const Hit& first,
                std::string& bytes) const;
    /// The records of a list's rays, by one thread.
    [[nodiscard]] std::string answer_rays(const RayTask& list, int worker);
    [[nodiscard]] RayListOptions ray_options() const;
    /// See ray_demand: of lists that are answered as a whole.
    [[nodiscard]] RayDemand demand_of_threads(bool begun) const;

    RendererOptions options_;
    CallbackWarnings warnings_;
    CallbackWarnings quiet_{{}};  ///< of scenes that are changes: what is to be said has been said
    StopFlag own_stop_;
    std::unique_ptr<SceneSession> session_;
    std::unique_ptr<const Tracer> direct_;  ///< see make_direct
    std::unique_ptr<Executor> executor_;
    WorkerContexts contexts_;
    std::vector<std::unique_ptr<RayTally>> tallies_;  ///< one a worker; none: see make_tally
    RunStatistics statistics_;

  private:
    mutable std::mutex mutex_;
    RenderProgress progress_;  ///< under the mutex
    // A walk's frames.
    std::optional<ProgressReporter> walk_reporter_;  ///< of the whole walk, while it lasts
    std::size_t frames_done_ = 0;
    int width_ = 0, height_ = 0;  ///< of the frames at hand
};

/// The bytes of a ray's answer where a renderer's options have no record of their own.
void append_ray_answer(const Ray& ray, const Hit& first, std::string& bytes);

}  // namespace lightwalk
