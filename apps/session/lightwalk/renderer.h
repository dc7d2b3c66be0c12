#pragma once
// The renderer: pictures of a scene, rays, and the frames of a walk, by the threads of this process
// or by many. Part of the public interface: no header of another library.
//
//   lightwalk::LoadedScene scene({"room.rad", "lamps.rad"});
//   lightwalk::Renderer renderer(scene, {});
//   const auto picture = renderer.finish(renderer.start(lightwalk::PictureTask{.view = view}));
//   lightwalk::save_picture("room.hdr", *picture);
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/session/lightwalk/picture.h"
#include "apps/session/lightwalk/scene.h"
#include "core/light/light_group_pattern.h"
#include "core/math/function_ref.h"
#include "core/trace/ray_query.h"
#include "core/transport/options.h"
#include "core/view/pixel_options.h"
#include "core/view/view.h"
#include "parallel/stop_flag.h"

namespace lightwalk {

class CheckpointSink;
class RayObserver;
class RayTally;
class RenderBackend;
class Tracer;
struct CloudOptions;
struct Hit;
struct Ray;
enum class ExecutorKind;

/// How far a task is.
struct RenderProgress {
    enum class Stage {
        waiting,  ///< nothing of it is done
        begun,
        running,
        finished,
        cancelled,
    };
    Stage stage = Stage::waiting;
    double done = 0;                     ///< share of the time it takes, 0 ... 1
    std::uint64_t rays = 0;              ///< traced so far
    double seconds = 0;                  ///< since it began
    std::optional<double> seconds_left;  ///< nothing: not known yet
    /// With a SampleGoal: relative error of luminance that 95 % of the pixels are within; nothing:
    /// not known.
    std::optional<double> error = {};
};

/// Told once when a task begins, once when it ends, and now and then in between; may be called from
/// several threads, but never twice at once.
using TakeProgressReport = std::function<void(const RenderProgress& progress)>;

/// What a renderer does with every task.
struct RendererOptions {
    RenderOptions light;  ///< how light is followed; defaults are those of Radiance's rpict
    PixelOptions pixels;  ///< how pictures are sampled
    /// Pictures get more samples, where they count most, until this is reached; pixels.samples are
    /// those that they begin with. Without reuse and checkpoints.
    SampleGoal goal;
    bool use_distances = false;  ///< distances count where pixels are interpolated and small light
                                 ///< sources drawn
    std::string ambient_file;  ///< indirect values are kept there, for other runs too; "": nowhere
    /// Fill the cache of indirect light by a coarse picture before each one.
    bool cache_prepass = true;
    /// The same bytes with any number of threads also with indirect light.
    bool deterministic = false;
    int threads = 0;  ///< 0: one for each processor
    /// Pictures are the frames of a walk: a frame takes what those before it have found and traces
    /// the rest. Null: each is traced by itself. See default_reuse().
    std::shared_ptr<const CloudOptions> reuse;
    std::size_t frames = 0;  ///< of the walk, for its progress; 0: not known
    TakeWarning warn;        ///< none: warnings are dropped
    TakeProgressReport progress;
    double progress_interval = 0.1;  ///< between two reports, at least [s]

    // For this project's own programs.
    std::optional<ExecutorKind> executor;  ///< what runs the threads; nothing: the usual one
    StopFlag* stop =
        nullptr;  ///< requested: as after cancel(), for good. Must outlive the renderer
    /// Of a run that goes on: the values that the ambient file had when it began are all that is
    /// taken from it (AmbientStore::beginning); "": all values are.
    std::string ambient_beginning = {};
    bool steered = false;             ///< frames() is used, and nothing else
    bool answers_rays = false;        ///< ray lists are started, and no pictures, by ranks
    RayObserver* observer = nullptr;  ///< watches the rays of ray lists, of one thread
    /// Turns ray `index` of a list, and its nearest hit before shading, into bytes: a list's answer
    /// is those of its rays one after the other. Called by many threads. None: RayResults.
    std::function<void(const RayQuery& query, const Ray& ray, const Hit& first, std::string& bytes)>
        record;
    /// Makes, for each thread, what answers ray lists in place of `record`: of the terms of their
    /// radiance. None: `record` does.
    std::function<std::unique_ptr<RayTally>(const Tracer& tracer)> make_tally;
    /// With tallies: what hemispheres see of indirect light is interpolated between records of
    /// coefficients. By one process.
    bool keep_coefficients = false;
    /// Pictures are made of layers, one for each group of emitters: these, or where the list is
    /// empty the usual ones (core/light/find_light_groups.h). Without reuse, but that of
    /// a steered walk.
    /// Nothing: there are no layers.
    std::optional<std::vector<LightGroupPattern>> light_groups;
    bool long_rays = false;  ///< rays of lists take long: they are dealt out one by one
    RayListOptions rays;     ///< what ray lists ask for
};

/// The options with which points are reused from frame to frame where nothing else is said.
[[nodiscard]] std::shared_ptr<const CloudOptions> default_reuse();

/// A picture, or a frame of a walk.
struct PictureTask {
    View view;
    std::optional<View> before;     ///< view of the frame before, for motion blur
    int width = 512, height = 512;  ///< [pixels]
    /// Blocks that an earlier run has kept are not rendered again, others are kept; null: none.
    std::shared_ptr<CheckpointSink> checkpoint;
};

/// Rays; each is answered with the random numbers of its place in the input, `first` + its index.
struct RayTask {
    std::vector<RayQuery> rays;
    std::uint64_t first = 0;
};

/// A task that was started; `Result` is what finish() returns for it.
template <class Result>
struct Ticket {
    std::uint64_t number = 0;
};

/// What ray lists answer: the bytes of RendererOptions::record.
struct RayBytes {
    std::string bytes;
    /// As the default record writes them. Throws InputError for other bytes.
    [[nodiscard]] std::vector<RayResult> answers() const;
};

/// How many ray lists are worth starting now.
struct RayDemand {
    std::size_t lists = 0;
    std::size_t rays = 0;   ///< in each, about
    bool answered = false;  ///< the oldest list that was started
};

/// Tasks are done in the order in which they were started. start(), poll() and finish() are for one
/// thread at a time; cancel() for any.
class Renderer {
  public:
    /// With the threads of this process. Throws InputError.
    Renderer(const LoadedScene& scene, const RendererOptions& options);
    /// With whatever does the work (apps/session/render_backend.h).
    explicit Renderer(std::unique_ptr<RenderBackend> backend);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Accept a task.
    [[nodiscard]] Ticket<RenderedPicture> start(PictureTask task);
    [[nodiscard]] Ticket<RayBytes> start(RayTask task);
    /// How far a task is; never waits. From the first call on the work goes on in the background.
    template <class Result>
    [[nodiscard]] RenderProgress poll(Ticket<Result> ticket) {
        return poll_task(ticket.number);
    }
    /// Do the task, or wait until it is done. Nothing: cancelled. Throws InputError for errors that
    /// only show while shading. A ticket is good for one call.
    [[nodiscard]] std::optional<RenderedPicture> finish(Ticket<RenderedPicture> ticket);
    [[nodiscard]] std::optional<RayBytes> finish(Ticket<RayBytes> ticket);
    /// Ends the tasks that were started, within about the time of a pixel; later ones are done.
    void cancel();

    /// So many pictures are worth starting before the first is finished.
    [[nodiscard]] std::size_t pictures_ahead() const;
    /// @param wait  until a further list is wanted, or the oldest one is answered
    [[nodiscard]] RayDemand ray_demand(bool wait);

    /// Where several processes share the work (lightwalk/ranks.h) each has a renderer, and runs it:
    /// calls `lead` in the one that gives out tasks, where it may use this object as above; in the
    /// others, and beside `lead`, does its share of their work until lead returns.
    void run(FunctionRef<void()> lead);
    /// What does the work; for this project's own programs (apps/session/render_backend.h).
    [[nodiscard]] RenderBackend& backend();

  private:
    [[nodiscard]] RenderProgress poll_task(std::uint64_t number);
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lightwalk
