#pragma once
// Pictures by the threads of this process.
#include <deque>

#include "apps/picture_maker.h"
#include "apps/progress.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "parallel/cache_prepass.h"

namespace lightwalk {

class LocalPictures final : public PictureMaker {
  public:
    /// Everything must outlive this; `statistics` gets what pictures cost.
    LocalPictures(const SceneSession& session, CachePrepass prepass, Executor& executor,
                  WorkerContexts& contexts, const ProgressOptions& progress,
                  StderrWarnings& warnings, RunStatistics& statistics)
        : session_(session),
          prepass_(prepass),
          executor_(executor),
          contexts_(contexts),
          progress_(progress),
          warnings_(warnings),
          statistics_(statistics) {}

    void order(std::shared_ptr<const PictureRequest> request) override {
        requests_.push_back(std::move(request));
    }
    [[nodiscard]] std::optional<Frame> take() override;
    [[nodiscard]] std::size_t ahead() const override { return 1; }

  private:
    [[nodiscard]] bool run_prepass(const PictureRequest& request, ProgressMeter& meter);

    const SceneSession& session_;
    CachePrepass prepass_;
    Executor& executor_;
    WorkerContexts& contexts_;
    ProgressOptions progress_;
    StderrWarnings& warnings_;
    RunStatistics& statistics_;
    std::deque<std::shared_ptr<const PictureRequest>> requests_;
};

}  // namespace lightwalk
