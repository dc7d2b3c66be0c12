#pragma once
// How far a picture is, on standard error.
#include <string>
#include <utility>

#include "apps/session/lightwalk/renderer.h"
#include "apps/warnings.h"

namespace lightwalk {

/// A bar, the share done, the speed, the error where it is known, and the time left, in at most
/// columns - 1 characters, because terminals wrap what fills their last column. What does not fit
/// is left out: the speed first, then the error, the bar, the time.
[[nodiscard]] std::string progress_line(const RenderProgress& progress, int columns);

/// Hours, minutes and seconds: "0:07", "12:30", "1:00:00".
[[nodiscard]] std::string time_text(double seconds);

struct ProgressOptions {
    bool bar = false;            ///< a line that is overwritten, on a terminal
    double report_interval = 0;  ///< > 0: seconds between report lines (-t)
    std::string program;
};

/// Prints what a renderer reports. Calls must not overlap.
class ProgressPrinter {
  public:
    /// @param warnings  share the terminal with the bar; must outlive this
    ProgressPrinter(ProgressOptions options, StderrWarnings& warnings)
        : options_(std::move(options)), warnings_(warnings) {}

    /// Between two reports, at least [s].
    [[nodiscard]] double interval() const {
        constexpr double kBarInterval = 0.1;
        return options_.report_interval > 0 ? options_.report_interval : kBarInterval;
    }
    void print(const RenderProgress& progress);

  private:
    void print_report(const RenderProgress& progress) const;

    ProgressOptions options_;
    StderrWarnings& warnings_;
};

}  // namespace lightwalk
