#pragma once
// Tells who waits for a picture how far it is.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/session/lightwalk/renderer.h"
#include "apps/session/stopwatch.h"
#include "parallel/progress.h"
#include "parallel/time_estimate.h"

namespace lightwalk {

/// Who is told, and how often.
struct ProgressListener {
    TakeProgressReport tell;  ///< none: nobody
    double interval = 0.1;    ///< between two reports, at least [s]
};

/// The reports of one task. Its calls must not overlap.
class ProgressReporter {
  public:
    /// Reports that the task begins.
    /// @param phases  of the task, in their order; at least one
    ProgressReporter(ProgressListener listener, std::vector<WorkPhase> phases);
    /// Takes what a phase says, and reports when it is time. Phases do not go back.
    void update(std::size_t phase, const FrameProgress& progress);
    /// Reports tell of it from now on.
    void set_error(std::optional<double> error) { error_ = error; }
    /// Reports the end.
    /// @param complete  false: cancelled
    /// @param rays      traced by all phases
    void finish(bool complete, std::uint64_t rays);

  private:
    void report(RenderProgress::Stage stage, double done);

    ProgressListener listener_;
    TimeEstimator estimator_;
    std::size_t phase_ = 0;
    std::uint64_t rays_before_ = 0, rays_ = 0;  ///< before the present phase, and with it
    std::optional<double> error_;
    Stopwatch watch_;
    double reported_ = 0;  ///< when the last report was made [s]
};

}  // namespace lightwalk
