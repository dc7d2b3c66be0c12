#pragma once
// How far a picture is, on standard error.
#include <string>

#include "apps/session/lightwalk/renderer.h"
#include "apps/warnings.h"

namespace lightwalk {

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
    void print_bar(const RenderProgress& progress) const;
    void print_report(const RenderProgress& progress) const;

    ProgressOptions options_;
    StderrWarnings& warnings_;
};

}  // namespace lightwalk
