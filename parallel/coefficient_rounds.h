#pragma once
// Fills a cache of coefficients, by all workers, with the same records for any number of them.
#include <optional>
#include <vector>

#include "core/ambient/coefficient_calculation.h"
#include "core/ambient/spacing_guess.h"
#include "core/math/function_ref.h"
#include "core/trace/ray_tally.h"
#include "parallel/comm/group.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// As AmbientRounds does it for ambient values: a round chooses points that are apart, computes
/// their records while the cache stays as it is, and stores them in the points' order. Where no
/// record is, rays go on by themselves, so that not every place needs one: few rays look, and where
/// none of these asks hardly any would. Several processes that do the same rounds share the
/// computing, and end with the same cache.
class CoefficientRounds {
  public:
    /// All must outlive this; `cache` is the one that `tracer` uses.
    /// @param tallies   one a worker: what its rays bring
    /// @param exchange  the processes that fill caches alike
    CoefficientRounds(const Tracer& tracer, CoefficientCache& cache, Executor& executor,
                      WorkerContexts& contexts, std::vector<RayTally*> tallies, Group& exchange,
                      const StopFlag& stop);

    /// Runs `trace`, which may trace rays by all workers, and computes records for the points where
    /// these found none, here or in another process. The rays' terms are told to nobody.
    /// @return  false: this process or another was requested to stop
    [[nodiscard]] bool fill(FunctionRef<void()> trace);

    struct Made {
        std::optional<CoefficientRecord> record;
        std::vector<CoefficientTerm> terms;
    };
    /// What a process tells the others at the end of a step.
    struct Share {
        bool stop = false;  ///< it was requested to stop
        std::vector<AmbientPoint> points;
        std::vector<Made> made;
    };

  private:
    [[nodiscard]] std::vector<Share> gather(Share mine);
    [[nodiscard]] std::vector<AmbientPoint> collect(FunctionRef<void()> trace);
    [[nodiscard]] std::vector<char> served(const AmbientPoint* points, std::size_t count);
    [[nodiscard]] std::vector<Made> compute(const std::vector<AmbientPoint>& chosen);

    const Tracer& tracer_;
    CoefficientCache& cache_;
    Executor& executor_;
    WorkerContexts& contexts_;
    std::vector<RayTally*> tallies_;
    Group& exchange_;
    const StopFlag& stop_;
    bool stopped_ = false;
    CoefficientCalculation calculation_;
    SpacingGuess guess_;
};

}  // namespace lightwalk
