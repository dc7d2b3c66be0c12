#pragma once
// One TraceContext for each worker of an executor.
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "core/trace/tracer.h"
#include "core/transport/light_groups.h"
#include "parallel/fibers/context_fibers.h"

namespace lightwalk {

/// Contexts are made on first use; the context of worker w may only be requested by the thread that
/// is worker w.
class WorkerContexts {
  public:
    WorkerContexts(const Tracer& tracer, WarningSink& warnings, int workers)
        : tracer_(tracer),
          warnings_(warnings),
          contexts_(static_cast<std::size_t>(workers)),
          sums_(static_cast<std::size_t>(workers)) {}

    [[nodiscard]] TraceContext& operator[](int worker) {
        std::unique_ptr<TraceContext>& context = contexts_[static_cast<std::size_t>(worker)];
        if (!context) {
            context = std::make_unique<TraceContext>(tracer_, warnings_);
            context->batches.make_fibers = make_context_fibers;
            if (groups_) listen(static_cast<std::size_t>(worker), *context);
        }
        return *context;
    }

    /// Sum the light of rays by groups from now on. Before the first context is requested.
    void sum_by(std::shared_ptr<const LightGroups> groups) { groups_ = std::move(groups); }
    /// Null: it is not.
    [[nodiscard]] const LightGroups* light_groups() const { return groups_.get(); }
    [[nodiscard]] const std::shared_ptr<const LightGroups>& shared_groups() const {
        return groups_;
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
    void listen(std::size_t worker, TraceContext& context) {
        sums_[worker] = std::make_unique<GroupSums>(groups_);
        context.contributions = context.groups = sums_[worker].get();
    }

    std::reference_wrapper<const Tracer> tracer_;
    std::reference_wrapper<WarningSink> warnings_;
    std::vector<std::unique_ptr<TraceContext>> contexts_;
    std::shared_ptr<const LightGroups> groups_;
    std::vector<std::unique_ptr<GroupSums>> sums_;  ///< one a context, where there are groups
};

}  // namespace lightwalk
