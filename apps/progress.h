#pragma once
// How far a picture is, for people who wait.
#include <chrono>
#include <string>

#include "parallel/frame.h"

namespace lightwalk {

struct ProgressOptions {
    bool bar = false;            ///< a line that is overwritten, on a terminal
    double report_interval = 0;  ///< > 0: seconds between report lines (-t)
    std::string program;
};

class ProgressMeter {
  public:
    explicit ProgressMeter(ProgressOptions options);
    /// Takes what the frame reports; prints when it is time.
    void update(const FrameProgress& progress);
    /// Last line, and the bar goes away.
    void finish(const FrameProgress& progress);

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] double seconds_since(Clock::time_point then) const;
    void print_bar(const FrameProgress& progress);
    void print_report(const FrameProgress& progress);

    ProgressOptions options_;
    Clock::time_point start_, last_;
};

/// Largest memory this process ever held [bytes].
[[nodiscard]] std::uint64_t peak_memory_bytes();

}  // namespace lightwalk
