#pragma once
// Pictures by the threads of this process.
#include <deque>
#include <memory>
#include <utility>

#include "apps/session/picture_maker.h"
#include "apps/session/progress_reporter.h"
#include "apps/session/run_statistics.h"
#include "apps/session/scene_session.h"
#include "parallel/cache_prepass.h"

namespace lightwalk {

/// What makers of pictures work with; all of it must outlive them.
struct LocalWorkers {
    const SceneSession& session;
    Executor& executor;
    WorkerContexts& contexts;   ///< of the session's tracer, one for each worker
    const StopFlag& stop;       ///< requested: what is under way ends
    RunStatistics& statistics;  ///< gets what pictures cost
};

class LocalPictures final : public PictureMaker {
  public:
    LocalPictures(const LocalWorkers& workers, CachePrepass prepass, ProgressListener listener)
        : workers_(workers), prepass_(prepass), listener_(std::move(listener)) {}

    void order(std::shared_ptr<const PictureRequest> request) override {
        requests_.push_back(std::move(request));
    }
    [[nodiscard]] std::optional<Frame> take() override;
    [[nodiscard]] std::size_t ahead() const override { return 1; }

  private:
    [[nodiscard]] bool run_prepass(const PictureRequest& request, ProgressReporter& reporter);

    LocalWorkers workers_;
    CachePrepass prepass_;
    ProgressListener listener_;
    std::deque<std::shared_ptr<const PictureRequest>> requests_;
};

}  // namespace lightwalk
