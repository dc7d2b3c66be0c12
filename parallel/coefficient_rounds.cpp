#include "parallel/coefficient_rounds.h"

#include <utility>

#include "parallel/waiting_points.h"

namespace lightwalk {
namespace {

constexpr std::size_t kPointsPerTask = 64;  ///< that are looked up

/// For its lifetime nobody is told the terms of rays, which are made of them all the same.
class Untold {
  public:
    explicit Untold(WorkerContexts& contexts) : contexts_(contexts) {
        for (int w = 0; w < contexts.size(); ++w)
            before_.push_back(std::exchange(contexts[w].contributions, &nobody_));
    }
    ~Untold() {
        for (int w = 0; w < contexts_.size(); ++w)
            contexts_[w].contributions = before_[static_cast<std::size_t>(w)];
    }
    Untold(const Untold&) = delete;
    Untold& operator=(const Untold&) = delete;

  private:
    class Nobody final : public ContributionSink {
      public:
        void add(const Contribution& /*term*/) override {}
    };
    WorkerContexts& contexts_;
    Nobody nobody_;
    std::vector<ContributionSink*> before_;
};

}  // namespace

CoefficientRounds::CoefficientRounds(const Tracer& tracer, CoefficientCache& cache,
                                     Executor& executor, WorkerContexts& contexts,
                                     std::vector<RayTally*> tallies, const StopFlag& stop)
    : tracer_(tracer),
      cache_(cache),
      executor_(executor),
      contexts_(contexts),
      tallies_(std::move(tallies)),
      stop_(stop),
      calculation_(tracer, cache),
      guess_(cache.limits()) {}

void CoefficientRounds::fill(FunctionRef<void()> trace) {
    WaitingPoints waiting(
        collect(trace), guess_,
        [this](const AmbientPoint* some, std::size_t count) { return served(some, count); });
    while (!stop_.requested() && !cache_.full()) {
        const std::vector<AmbientPoint> chosen =
            waiting.choose(WaitingPoints::most_values(cache_.size()));
        if (chosen.empty()) return;
        const std::vector<Made> made = compute(chosen);
        if (stop_.requested()) return;
        for (const Made& one : made) {
            if (!one.record || cache_.full()) continue;
            cache_.insert(*one.record, one.terms);
            guess_.add(one.record->position, one.record->normal, CoefficientCache::kLevel,
                       one.record->reach);
        }
    }
}

std::vector<AmbientPoint> CoefficientRounds::collect(FunctionRef<void()> trace) {
    const Untold untold(contexts_);
    const CollectingPoints collecting(contexts_);
    trace();
    return stop_.requested() ? std::vector<AmbientPoint>() : collecting.points();
}

/// Whether there is a record for each of some points.
std::vector<char> CoefficientRounds::served(const AmbientPoint* points, std::size_t count) {
    std::vector<char> result(count, 0);
    executor_.for_each((count + kPointsPerTask - 1) / kPointsPerTask, [&](std::size_t task, int) {
        const std::size_t last = std::min(count, (task + 1) * kPointsPerTask);
        CoefficientScratch scratch;
        for (std::size_t i = task * kPointsPerTask; i < last; ++i)
            result[i] = calculation_.is_served(points[i], scratch) ? 1 : 0;
    });
    return result;
}

/// The records of the points, in their order; after a stop, some of them.
std::vector<CoefficientRounds::Made> CoefficientRounds::compute(
    const std::vector<AmbientPoint>& chosen) {
    std::vector<Made> made(chosen.size());
    executor_.for_each(
        chosen.size(),
        [&](std::size_t task, int worker) {
            Made& own = made[task];
            const std::optional<double> reach = calculation_.reach_at(chosen[task]);
            if (!reach) return;
            own.record = calculation_.record_at(chosen[task], *reach, contexts_[worker]);
            own.terms = tallies_[static_cast<std::size_t>(worker)]->take_terms();
        },
        stop_);
    return made;
}

}  // namespace lightwalk
