#pragma once
// One TraceContext for each worker of an executor.
#include <cstddef>
#include <memory>
#include <vector>

#include "core/trace/tracer.h"
#include "parallel/fibers/context_fibers.h"

namespace lightwalk {

/// Contexts are made on first use; the context of worker w may only be requested by the thread that
/// is worker w.
class WorkerContexts {
  public:
    WorkerContexts(const Tracer& tracer, WarningSink& warnings, int workers)
        : tracer_(tracer), warnings_(warnings), contexts_(static_cast<std::size_t>(workers)) {}

    [[nodiscard]] TraceContext& operator[](int worker) {
        std::unique_ptr<TraceContext>& context = contexts_[static_cast<std::size_t>(worker)];
        if (!context) {
            context = std::make_unique<TraceContext>(tracer_, warnings_);
            context->batches.make_fibers = make_context_fibers;
        }
        return *context;
    }

    [[nodiscard]] int size() const { return static_cast<int>(contexts_.size()); }

    /// Reset the counters to zero. Must not be called while a task runs.
    void reset_counters() {
        for (const auto& context : contexts_) {
            if (context) context->counters = {};
        }
    }

    /// The rays traced by all workers so far. Must not be called while a task runs.
    [[nodiscard]] RayCounters rays() const {
        RayCounters sum;
        for (const auto& context : contexts_) {
            if (context) sum += context->counters.rays;
        }
        return sum;
    }

    [[nodiscard]] AmbientCounters ambient() const {
        AmbientCounters sum;
        for (const auto& context : contexts_) {
            if (context) sum += context->counters.ambient;
        }
        return sum;
    }

  private:
    const Tracer& tracer_;
    WarningSink& warnings_;
    std::vector<std::unique_ptr<TraceContext>> contexts_;
};

}  // namespace lightwalk
