#pragma once
// Warnings on standard error.
#include <map>
#include <mutex>
#include <string>

#include "core/error.h"

namespace lightwalk {

/// Prints each message once, and at the end how often the repeated ones came. Callable from many
/// threads.
class StderrWarnings final : public WarningSink {
  public:
    explicit StderrWarnings(std::string program) : program_(std::move(program)) {}
    ~StderrWarnings() override;
    StderrWarnings(const StderrWarnings&) = delete;
    StderrWarnings& operator=(const StderrWarnings&) = delete;

    void warn(const std::string& text) override;
    /// Off: stay silent (-w-).
    void enable(bool on) { enabled_ = on; }
    /// Before each message: end the progress bar's line.
    void use_terminal_line(bool on) { clear_line_ = on; }

  private:
    std::string program_;
    std::mutex mutex_;
    std::map<std::string, long> counts_;
    long suppressed_ = 0;
    bool enabled_ = true, clear_line_ = false;
};

}  // namespace lightwalk
