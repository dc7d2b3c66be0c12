#pragma once
// What does a renderer's work: the threads of this process, or ranks that share it.
#include <mutex>

#include "apps/session/compiled_scene.h"
#include "apps/session/lightwalk/renderer.h"
#include "apps/session/picture_maker.h"
#include "apps/session/progress_reporter.h"
#include "apps/session/ray_maker.h"
#include "apps/session/run_statistics.h"
#include "apps/session/scene_session.h"
#include "core/math/function_ref.h"
#include "parallel/cache_prepass.h"
#include "parallel/frame_options.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/live_frames.h"

namespace lightwalk {

class RenderBackend {
  public:
    explicit RenderBackend(RendererOptions options);
    virtual ~RenderBackend() = default;
    RenderBackend(const RenderBackend&) = delete;
    RenderBackend& operator=(const RenderBackend&) = delete;

    [[nodiscard]] const RendererOptions& options() const { return options_; }
    /// Of pictures of a size; a walk that is steered traces every pixel.
    [[nodiscard]] FrameOptions frame_options(int width, int height) const;
    /// Requested: ends what is under way.
    [[nodiscard]] StopFlag& stop() { return options_.stop != nullptr ? *options_.stop : own_stop_; }
    /// What was reported last.
    [[nodiscard]] RenderProgress progress() const;

    /// See Renderer::run.
    virtual void run(FunctionRef<void()> lead) = 0;
    /// Whether this process gives out the work.
    [[nodiscard]] virtual bool leads() const = 0;
    [[nodiscard]] virtual const SceneSession& session() const = 0;
    // Of these three one is used, as the options say; where this process leads.
    [[nodiscard]] virtual PictureMaker& pictures() = 0;
    [[nodiscard]] virtual RayMaker& rays() = 0;
    [[nodiscard]] virtual LiveFrames& frames() = 0;
    /// What the work has taken so far; on ranks, after run(), that of all of them.
    [[nodiscard]] virtual RunStatistics statistics() const = 0;

  protected:
    [[nodiscard]] WarningSink& warnings() { return warnings_; }
    /// Whom makers of pictures tell.
    [[nodiscard]] ProgressListener listener();
    /// How the cache of indirect light is filled before a picture.
    [[nodiscard]] CachePrepass prepass() const;
    [[nodiscard]] LightSettings light() const { return {options_.light, options_.ambient_file}; }

  private:
    RendererOptions options_;
    CallbackWarnings warnings_;
    StopFlag own_stop_;
    mutable std::mutex mutex_;
    RenderProgress progress_;  ///< under the mutex
};

/// The tracer of a scene without indirect light; null: it has none anyway. The session must outlive
/// it.
[[nodiscard]] std::unique_ptr<const Tracer> without_indirect(const SceneSession& session,
                                                             WarningSink& warnings);

/// The bytes of a ray's answer where a renderer's options have no record of their own.
void append_ray_answer(const Ray& ray, const Hit& first, std::string& bytes);

}  // namespace lightwalk
