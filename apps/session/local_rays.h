#pragma once
// Lists of rays by the threads of this process.
#include <deque>

#include "apps/session/ray_maker.h"
#include "core/trace/tracer.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

class LocalRays final : public RayMaker {
  public:
    /// All must outlive this.
    /// @param options  with a record
    LocalRays(const Tracer& tracer, Executor& executor, WorkerContexts& contexts,
              const RendererOptions& options, const StopFlag& stop);

    void order(RayTask list) override { lists_.push_back(std::move(list)); }
    [[nodiscard]] std::optional<std::string> take() override;
    /// The work is done by take(): there is nothing to wait for.
    [[nodiscard]] RayDemand demand(bool wait) override;

  private:
    const Tracer& tracer_;
    Executor& executor_;
    WorkerContexts& contexts_;
    const RendererOptions& options_;
    const StopFlag& stop_;
    std::deque<RayTask> lists_;
    std::vector<std::string> records_;  ///< of the tasks of a list
};

/// The records of a list's rays, by one thread.
[[nodiscard]] std::string answer_rays(const Tracer& tracer, TraceContext& context,
                                      const RayTask& list, const RendererOptions& options);

}  // namespace lightwalk
