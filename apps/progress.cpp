#include "apps/progress.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace lightwalk {
namespace {

constexpr double kBarInterval = 0.1;  // [s]

double hours(const timeval& time) {
    return (static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec)) / 3600;
}

std::string rate_text(double per_second) {
    std::array<char, 64> text{};
    if (per_second >= 1e6)
        std::snprintf(text.data(), text.size(), "%.2f Mrays/s", per_second * 1e-6);
    else
        std::snprintf(text.data(), text.size(), "%.1f krays/s", per_second * 1e-3);
    return text.data();
}

std::string time_text(double seconds) {
    const long whole = std::lround(std::clamp(seconds, 0.0, 3.6e6));
    std::array<char, 64> text{};
    if (whole >= 3600)
        std::snprintf(text.data(), text.size(), "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60,
                      whole % 60);
    else
        std::snprintf(text.data(), text.size(), "%ld:%02ld", whole / 60, whole % 60);
    return text.data();
}

}  // namespace

ProgressMeter::ProgressMeter(ProgressOptions options)
    : options_(std::move(options)), start_(Clock::now()), last_(start_) {
    if (options_.report_interval > 0) print_report({});
}

double ProgressMeter::seconds_since(Clock::time_point then) const {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

void ProgressMeter::update(const FrameProgress& progress) {
    const double interval = options_.report_interval > 0 ? options_.report_interval : kBarInterval;
    if (progress.done >= 1 || seconds_since(last_) < interval) return;
    if (options_.report_interval > 0)
        print_report(progress);
    else if (options_.bar)
        print_bar(progress);
    last_ = Clock::now();
}

void ProgressMeter::finish(const FrameProgress& progress) {
    if (options_.report_interval > 0)
        print_report(progress);
    else if (options_.bar)
        std::fputs("\r\033[K", stderr);
}

void ProgressMeter::print_bar(const FrameProgress& progress) {
    constexpr std::size_t kWidth = 30;
    const auto filled = static_cast<std::size_t>(progress.done * static_cast<double>(kWidth));
    const std::string bar =
        std::string(filled, '#') + std::string(kWidth - std::min(filled, kWidth), '.');
    const double seconds = std::max(seconds_since(start_), 1e-3);
    const double left = progress.done > 0 ? seconds * (1 - progress.done) / progress.done : 0;
    std::fprintf(stderr, "\r\033[K[%s] %5.1f %%  %s  %s left", bar.c_str(), 100 * progress.done,
                 rate_text(static_cast<double>(progress.rays) / seconds).c_str(),
                 time_text(left).c_str());
}

void ProgressMeter::print_report(const FrameProgress& progress) {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::array<char, 256> host{};
    if (gethostname(host.data(), host.size() - 1) != 0) host.front() = '\0';
    std::fprintf(stderr, "%s: %llu rays, %4.2f%% after %.3fu %.3fs %.3fr hours on %s (PID %ld)\n",
                 options_.program.c_str(), static_cast<unsigned long long>(progress.rays),
                 100 * progress.done, hours(used.ru_utime), hours(used.ru_stime),
                 seconds_since(start_) / 3600, host.data(), static_cast<long>(getpid()));
}

std::uint64_t peak_memory_bytes() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<std::uint64_t>(used.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace lightwalk
