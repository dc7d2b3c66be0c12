#pragma once
// The frames of a walk by the threads of this process.
#include <memory>

#include "apps/walk_pictures.h"
#include "parallel/cache_prepass.h"

namespace lightwalk {

class CloudPictures final : public WalkPictures {
  public:
    /// Everything must outlive this; see WalkPictures.
    CloudPictures(const SceneSession& session, CachePrepass prepass, const CloudOptions& options,
                  std::size_t frames, Executor& executor, WorkerContexts& contexts,
                  const ProgressOptions& progress, StderrWarnings& warnings,
                  RunStatistics& statistics)
        : WalkPictures(options, frames, executor.concurrency(), progress, warnings, statistics),
          session_(session),
          prepass_(prepass),
          executor_(executor),
          contexts_(contexts) {}

  private:
    [[nodiscard]] std::unique_ptr<LiveFrames> make_frames(const FrameOptions& options) override;
    [[nodiscard]] bool prepare(const PictureRequest& request, bool first) override;

    const SceneSession& session_;
    CachePrepass prepass_;
    Executor& executor_;
    WorkerContexts& contexts_;
};

}  // namespace lightwalk
