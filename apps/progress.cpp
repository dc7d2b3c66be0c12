#include "apps/progress.h"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "apps/progress_line.h"

namespace lightwalk {
namespace {

constexpr double kBarInterval = 0.1;  // [s]

double hours(const timeval& time) {
    return (static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec)) / 3600;
}

/// Of the terminal behind standard error, which may change while we print.
int terminal_columns() {
    constexpr int kUsual = 80;
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : kUsual;
}

}  // namespace

ProgressMeter::ProgressMeter(ProgressOptions options, std::vector<WorkPhase> phases)
    : options_(std::move(options)),
      estimator_(std::move(phases)),
      start_(Clock::now()),
      last_(start_) {
    if (options_.report_interval > 0) print_report(0);
}

double ProgressMeter::seconds_since(Clock::time_point then) const {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

void ProgressMeter::update(std::size_t phase, const FrameProgress& progress) {
    if (phase != phase_) rays_before_ = rays_;
    phase_ = phase;
    rays_ = rays_before_ + progress.rays;
    estimator_.add(phase, seconds_since(start_), progress);
    const double interval = options_.report_interval > 0 ? options_.report_interval : kBarInterval;
    if (seconds_since(last_) < interval) return;
    if (options_.report_interval > 0)
        print_report(estimator_.estimate().done);
    else if (options_.bar)
        print_bar();
    last_ = Clock::now();
}

void ProgressMeter::finish(bool complete, std::uint64_t rays) {
    rays_ = rays;
    if (options_.report_interval > 0)
        print_report(complete ? 1 : estimator_.estimate().done);
    else if (options_.bar)
        std::fputs("\r\033[K", stderr);
}

void ProgressMeter::print_bar() const {
    const TimeEstimate estimate = estimator_.estimate();
    const double seconds = std::max(seconds_since(start_), 1e-3);
    const std::string line =
        progress_line({estimate.done, static_cast<double>(rays_) / seconds, estimate.seconds_left},
                      terminal_columns());
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
}

void ProgressMeter::print_report(double done) const {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::array<char, 256> host{};
    if (gethostname(host.data(), host.size() - 1) != 0) host.front() = '\0';
    std::fprintf(stderr, "%s: %llu rays, %4.2f%% after %.3fu %.3fs %.3fr hours on %s (PID %ld)\n",
                 options_.program.c_str(), static_cast<unsigned long long>(rays_), 100 * done,
                 hours(used.ru_utime), hours(used.ru_stime), seconds_since(start_) / 3600,
                 host.data(), static_cast<long>(getpid()));
}

std::uint64_t peak_memory_bytes() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<std::uint64_t>(used.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace lightwalk
