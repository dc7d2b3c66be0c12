#pragma once
// The frames of a walk by the threads of this process.
#include <memory>

#include "apps/session/local_pictures.h"
#include "apps/session/walk_pictures.h"

namespace lightwalk {

class CloudPictures final : public WalkPictures {
  public:
    /// Everything must outlive this; see WalkPictures.
    CloudPictures(const LocalWorkers& workers, CachePrepass prepass, const CloudOptions& options,
                  std::size_t frames, ProgressListener listener, WarningSink& warnings)
        : WalkPictures(options, frames, workers.executor.concurrency(), std::move(listener),
                       workers.stop, workers.statistics),
          workers_(workers),
          prepass_(prepass),
          warnings_(warnings) {}

  private:
    [[nodiscard]] std::unique_ptr<LiveFrames> make_frames(const FrameOptions& options) override;
    [[nodiscard]] bool prepare(const PictureRequest& request, bool first) override;

    LocalWorkers workers_;
    CachePrepass prepass_;
    WarningSink& warnings_;
};

}  // namespace lightwalk
