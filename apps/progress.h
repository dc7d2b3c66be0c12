#pragma once
// How far a picture is, for people who wait.
#include <chrono>
#include <string>
#include <vector>

#include "parallel/progress.h"
#include "parallel/time_estimate.h"

namespace lightwalk {

struct ProgressOptions {
    bool bar = false;            ///< a line that is overwritten, on a terminal
    double report_interval = 0;  ///< > 0: seconds between report lines (-t)
    std::string program;
};

class ProgressMeter {
  public:
    /// @param phases  of the picture, in their order
    ProgressMeter(ProgressOptions options, std::vector<WorkPhase> phases);
    /// Takes what a phase reports; prints when it is time. Phases do not go back.
    void update(std::size_t phase, const FrameProgress& progress);
    /// Last line, and the bar goes away.
    /// @param complete  the picture is finished; false: stopped
    /// @param rays      traced by all phases
    void finish(bool complete, std::uint64_t rays);

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] double seconds_since(Clock::time_point then) const;
    void print_bar() const;
    void print_report(double done) const;

    ProgressOptions options_;
    TimeEstimator estimator_;
    std::size_t phase_ = 0;
    std::uint64_t rays_before_ = 0, rays_ = 0;  ///< before the present phase, and with it
    Clock::time_point start_, last_;
};

/// Largest memory this process ever held [bytes].
[[nodiscard]] std::uint64_t peak_memory_bytes();

}  // namespace lightwalk
