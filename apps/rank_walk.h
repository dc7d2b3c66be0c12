#pragma once
// The frames of a walk, each from the points of those before it, by many ranks.
#include <memory>

#include "apps/rank_frames.h"
#include "apps/rank_link.h"
#include "apps/rank_work.h"
#include "apps/session/scene_session.h"
#include "apps/session/walk_pictures.h"
#include "core/cloud/visibility_probe.h"
#include "parallel/cache_prepass.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Rank 0's frames, which all ranks draw.
class LeadWalk final : public WalkPictures {
  public:
    /// Everything must outlive this; see WalkPictures.
    LeadWalk(RankLink& link, const Tracer& tracer, const CloudOptions& options, std::size_t frames,
             ProgressListener listener, WarningSink& warnings, const StopFlag& stop,
             RunStatistics& statistics)
        : WalkPictures(options, frames, 1, std::move(listener), stop, statistics),
          link_(link),
          tracer_(tracer),
          warnings_(warnings),
          executor_(make_executor(ExecutorKind::serial, 1)) {}

  private:
    [[nodiscard]] std::unique_ptr<LiveFrames> make_frames(const FrameOptions& options) override;

    RankLink& link_;
    const Tracer& tracer_;
    WarningSink& warnings_;
    std::unique_ptr<Executor> executor_;  ///< of what rank 0 draws by itself
};

/// Draws a rank's parts of these frames.
class RankWalk final : public RankWork {
  public:
    /// Everything must outlive this.
    /// @param options     of all frames, but for what an order says
    /// @param projectors  ranks that own a part of the frames, at most
    RankWalk(RankLink& link, const SceneSession& session, CachePrepass prepass,
             const FrameOptions& options, const CloudOptions& cloud, int projectors,
             WorkerContexts& contexts, WarningSink& warnings, const StopFlag& stop)
        : link_(link),
          session_(session),
          prepass_(prepass),
          options_(options),
          cloud_(cloud),
          projectors_(projectors),
          contexts_(contexts),
          warnings_(warnings),
          stop_(stop),
          probe_(session.tracer()) {}

    /// Orders that want direct light alone get this; without, they get what the session has.
    void set_direct(WalkLight& direct) { direct_ = &direct; }

    void trace(Executor& executor) override;
    [[nodiscard]] RayCounters rays() const override;
    [[nodiscard]] AmbientCounters ambient() const override;

  private:
    [[nodiscard]] std::unique_ptr<SceneCaster> make_rays(const FrameOrder& order,
                                                         Executor& executor);
    void run_prepass(const Camera& camera, FrameOptions options, Executor& executor);

    RankLink& link_;
    const SceneSession& session_;
    CachePrepass prepass_;
    FrameOptions options_;
    CloudOptions cloud_;
    int projectors_;
    WorkerContexts& contexts_;
    WarningSink& warnings_;
    const StopFlag& stop_;
    VisibilityProbe probe_;
    WalkLight* direct_ = nullptr;
    RayCounters prepass_rays_;
    AmbientCounters prepass_ambient_;
};

}  // namespace lightwalk
