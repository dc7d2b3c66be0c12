#pragma once
// Deterministic parallel computation of ambient values in rounds: the same values for any number of
// workers.
#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "core/ambient/ambient_calculation.h"
#include "core/ambient/ambient_point.h"
#include "core/ambient/spacing_guess.h"
#include "core/math/function_ref.h"
#include "parallel/checkpoint_sink.h"
#include "parallel/comm/group.h"
#include "parallel/executor.h"
#include "parallel/published_cache.h"
#include "parallel/round_bytes.h"
#include "parallel/stop_flag.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Fills a cache with the values that one worker would compute who visits the points in a fixed
/// order (deterministic reservations), after Blelloch, Fineman, Gibbons & Shun, "Internally
/// Deterministic Parallel Algorithms Can Be Fast", PPoPP 2012. A round chooses points from the head
/// of that order, far enough apart that none of their values is likely to serve another's point;
/// computes all of them at once, while the cache stays as the rounds before have left it; and
/// stores them in their order. The values of deeper levels that those will need come first, in
/// rounds of their own: Jones & Reinhart, "Parallel Multiple-Bounce Irradiance Caching", EGSR 2016.
/// Several processes that do the same rounds share the computing, and end with the same cache.
///
/// A round has steps: points are found, or values computed. A checkpoint keeps what came of each,
/// so that a later run which begins with the same cache need only read it, by any number of
/// processes.
class AmbientRounds {
  public:
    /// Statistics of one ambient level.
    struct Counts {
        std::size_t rounds = 0;
        std::size_t values = 0;  ///< computed in them
        std::size_t needless =
            0;  ///< of these: values for which another value of their round could have been used
        std::size_t new_records = 0;  ///< computed on the way to values of the level above
    };

    /// All must outlive this; `cache` is the one that `tracer` uses, and is left frozen: it takes
    /// no values but those of the rounds.
    /// @param after_round  called after each round, in the calling thread, with the number of
    /// points of level 0 that remain
    /// @param checkpoint  of one of the processes at most; null: none
    AmbientRounds(const Tracer& tracer, PublishedCache& cache, Executor& executor,
                  WorkerContexts& contexts, Group& exchange, const StopFlag& stop,
                  std::function<void(std::size_t left)> after_round,
                  CheckpointSink* checkpoint = nullptr);

    /// Runs `trace`, which may trace rays by all workers, and returns the points for which it found
    /// no ambient value, in this process or another.
    [[nodiscard]] std::vector<AmbientPoint> collect(FunctionRef<void()> trace);

    /// Compute values until each of the points, which must be of one level, has a usable value, or
    /// cannot have one. The result is independent of their order.
    void compute_in_rounds(std::vector<AmbientPoint> points);

    /// Whether this process or another was requested to stop; no more work is done then.
    [[nodiscard]] bool stopped() const { return stopped_; }
    /// Whether pixels need values at points inside clipped matter or a mist, which rounds cannot
    /// compute.
    [[nodiscard]] bool left_out() const { return left_out_; }
    [[nodiscard]] const std::vector<Counts>& counts() const { return counts_; }  ///< by level

  private:
    void agree_on_known();
    [[nodiscard]] bool is_known() const { return steps_ < known_steps_; }
    [[nodiscard]] RoundShare take_known();
    void keep(const RoundShare& step);
    [[nodiscard]] std::vector<RoundShare> gather(RoundShare mine);
    [[nodiscard]] std::vector<char> served(const AmbientPoint* points, std::size_t count);
    void prepare(const std::vector<AmbientPoint>& chosen);
    [[nodiscard]] std::vector<RoundValue> compute(const std::vector<AmbientPoint>& chosen);
    [[nodiscard]] std::vector<RoundValue> look_up(std::size_t count);
    void store(const std::vector<AmbientPoint>& chosen, const std::vector<RoundValue>& values);
    void store(const AmbientRecord& record, std::span<const Rgb> groups);

    const Tracer& tracer_;
    PublishedCache& cache_;
    Executor& executor_;
    WorkerContexts& contexts_;
    Group& exchange_;
    const StopFlag& stop_;
    std::function<void(std::size_t)> after_round_;
    CheckpointSink* checkpoint_;
    std::deque<std::string> known_;  ///< steps that are still to come; of who has the checkpoint
    std::size_t known_steps_ = 0;    ///< of all processes
    std::size_t steps_ = 0;          ///< that are done
    AmbientCalculation calculation_;
    SpacingGuess guess_;
    std::vector<Counts> counts_;
    std::size_t left_ = 0;  ///< points of level 0
    bool stopped_ = false, left_out_ = false;
};

}  // namespace lightwalk
