#pragma once
// Ambient values for many points at once, in rounds: the same values for any number of workers.
#include <cstddef>
#include <functional>
#include <vector>

#include "core/ambient/ambient_calculation.h"
#include "core/ambient/ambient_point.h"
#include "core/math/function_ref.h"
#include "parallel/executor.h"
#include "parallel/freezable_cache.h"
#include "parallel/round_bytes.h"
#include "parallel/round_exchange.h"
#include "parallel/spacing_guess.h"
#include "parallel/stop_flag.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Fills a cache as one worker would who takes the points in a fixed order, after Blelloch,
/// Fineman, Gibbons & Shun, "Internally Deterministic Parallel Algorithms Can Be Fast", PPoPP 2012.
/// A round chooses points from the head of that order, far enough apart that none of their values
/// is likely to serve another's point; computes all of them at once, while the cache stays as the
/// rounds before have left it; and stores them in their order. The values of deeper levels that
/// those will need come first, in rounds of their own: Jones & Reinhart, "Parallel Multiple-Bounce
/// Irradiance Caching", EGSR 2016. Several processes that do the same rounds share the computing,
/// and end with the same cache.
class AmbientRounds {
  public:
    /// What was done, for one level.
    struct Counts {
        std::size_t rounds = 0;
        std::size_t values = 0;       ///< computed in them
        std::size_t needless = 0;     ///< of these: another one of their round would have served
        std::size_t new_records = 0;  ///< computed on the way to values of the level above
    };

    /// All must outlive this; `cache` is the one that `tracer` uses, and is left frozen: it takes
    /// no values but those of the rounds.
    /// @param after_round  called after each, on the calling thread, with the number of points of
    ///                     level 0 that are still to be looked at
    AmbientRounds(const Tracer& tracer, FreezableCache& cache, Executor& executor,
                  WorkerContexts& contexts, RoundExchange& exchange, const StopFlag& stop,
                  std::function<void(std::size_t left)> after_round);

    /// The points that `trace`, which may trace rays by all workers, finds to miss a value, in any
    /// of the processes.
    [[nodiscard]] std::vector<AmbientPoint> collect(FunctionRef<void()> trace);

    /// Compute values until each of the points, which are of one level, has one that serves it, or
    /// cannot have. Their order does not matter.
    void compute_in_rounds(std::vector<AmbientPoint> points);

    /// A stop was requested, of this process or of another: nothing is done any more.
    [[nodiscard]] bool stopped() const { return stopped_; }
    /// Pixels missed values at points that do not stand alone, which rounds leave out.
    [[nodiscard]] bool left_out() const { return left_out_; }
    [[nodiscard]] const std::vector<Counts>& counts() const { return counts_; }  ///< by level

  private:
    class Waiting;
    [[nodiscard]] std::vector<std::string> gather(std::string mine);
    [[nodiscard]] std::vector<char> served(const AmbientPoint* points, std::size_t count);
    void prepare(const std::vector<AmbientPoint>& chosen);
    [[nodiscard]] std::vector<RoundValue> compute(const std::vector<AmbientPoint>& chosen);
    void store(const std::vector<AmbientPoint>& chosen, const std::vector<RoundValue>& values);
    void store(const AmbientRecord& record);

    const Tracer& tracer_;
    FreezableCache& cache_;
    Executor& executor_;
    WorkerContexts& contexts_;
    RoundExchange& exchange_;
    const StopFlag& stop_;
    std::function<void(std::size_t)> after_round_;
    AmbientCalculation calculation_;
    SpacingGuess guess_;
    std::vector<Counts> counts_;
    std::size_t left_ = 0;  ///< points of level 0
    bool stopped_ = false, left_out_ = false;
};

}  // namespace lightwalk
