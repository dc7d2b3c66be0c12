#pragma once
// The frames of a walk, each from the points of those before it, by many ranks.
#include <deque>
#include <memory>
#include <optional>

#include "apps/picture_maker.h"
#include "apps/progress.h"
#include "apps/rank_link.h"
#include "apps/rank_work.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "core/cloud/visibility_probe.h"
#include "parallel/cache_prepass.h"
#include "parallel/ranks/cloud_lead.h"
#include "parallel/walk/live_frames.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Rank 0's frames, which all ranks draw.
class LeadWalk final : public PictureMaker {
  public:
    /// Everything must outlive this; `statistics` gets what the frames cost, but for the rays.
    /// Frames of another size than the one before start anew.
    /// @param frames  that will be asked for
    LeadWalk(RankLink& link, const Tracer& tracer, const CloudOptions& options, std::size_t frames,
             const ProgressOptions& progress, StderrWarnings& warnings, RunStatistics& statistics);
    ~LeadWalk() override;

    void order(std::shared_ptr<const PictureRequest> request) override {
        requests_.push_back(std::move(request));
    }
    [[nodiscard]] std::optional<Frame> take() override;
    /// A frame is drawn from the points that the one before it leaves; but who draws it wants to
    /// know whether the view will rest.
    [[nodiscard]] std::size_t ahead() const override { return 2; }

  private:
    void begin(const FrameOptions& options);

    RankLink& link_;
    const Tracer& tracer_;
    CloudOptions options_;
    std::size_t frames_wanted_, frames_done_ = 0;
    ProgressOptions progress_;
    StderrWarnings& warnings_;
    RunStatistics& statistics_;
    std::unique_ptr<Executor> executor_;  ///< of what rank 0 draws by itself
    WorkerContexts contexts_;
    std::optional<ProgressMeter> meter_;  ///< of the whole walk, while it lasts
    std::optional<CloudLead> lead_;
    int width_ = 0, height_ = 0;  ///< of the frames that it leads
    std::deque<std::shared_ptr<const PictureRequest>> requests_;
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

    void serve(Executor& executor) override;
    [[nodiscard]] RayCounters rays() const override;
    [[nodiscard]] AmbientCounters ambient() const override;

  private:
    [[nodiscard]] std::unique_ptr<WalkRays> make_rays(const CloudOrder& order, Executor& executor);
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
