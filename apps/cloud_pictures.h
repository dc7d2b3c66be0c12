#pragma once
// The frames of a walk by the threads of this process, each from the points of those before it.
#include <deque>
#include <memory>
#include <optional>

#include "apps/picture_maker.h"
#include "apps/progress.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "core/cloud/visibility_probe.h"
#include "parallel/cache_prepass.h"
#include "parallel/walk/cloud_frames.h"

namespace lightwalk {

class CloudPictures final : public PictureMaker {
  public:
    /// Everything must outlive this; `statistics` gets what the frames cost. Frames of another size
    /// than the one before start anew.
    /// @param frames  that will be asked for
    CloudPictures(const SceneSession& session, CachePrepass prepass, const CloudOptions& options,
                  std::size_t frames, Executor& executor, WorkerContexts& contexts,
                  ProgressOptions progress, StderrWarnings& warnings, RunStatistics& statistics)
        : session_(session),
          prepass_(prepass),
          options_(options),
          frames_wanted_(frames),
          executor_(executor),
          contexts_(contexts),
          progress_(std::move(progress)),
          warnings_(warnings),
          statistics_(statistics),
          probe_(session.tracer()) {}

    void order(std::shared_ptr<const PictureRequest> request) override {
        requests_.push_back(std::move(request));
    }
    [[nodiscard]] std::optional<Frame> take() override;
    [[nodiscard]] std::size_t ahead() const override { return 1; }

  private:
    void begin_progress(const FrameOptions& options);
    void end_progress(bool complete);
    [[nodiscard]] bool run_prepass(const PictureRequest& request, bool first);

    const SceneSession& session_;
    CachePrepass prepass_;
    CloudOptions options_;
    std::size_t frames_wanted_, frames_done_ = 0;
    Executor& executor_;
    WorkerContexts& contexts_;
    ProgressOptions progress_;
    StderrWarnings& warnings_;
    RunStatistics& statistics_;
    VisibilityProbe probe_;
    std::optional<ProgressMeter> meter_;  ///< of the whole walk, while it lasts
    std::optional<CloudFrames> frames_;
    int width_ = 0, height_ = 0;  ///< of frames_
    std::deque<std::shared_ptr<const PictureRequest>> requests_;
};

}  // namespace lightwalk
