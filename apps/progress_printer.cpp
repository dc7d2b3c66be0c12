#include "apps/progress_printer.h"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace lightwalk {
namespace {

constexpr int kShortestBar = 8, kLongestBar = 40;  // [characters] without its brackets

std::string formatted(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string rate_text(const RenderProgress& progress) {
    const double per_second = static_cast<double>(progress.rays) / std::max(progress.seconds, 1e-3);
    return per_second >= 1e6 ? formatted("  %.2f Mrays/s", per_second * 1e-6)
                             : formatted("  %.1f krays/s", per_second * 1e-3);
}

std::string bar_text(double share, int length) {
    const int filled = std::clamp(static_cast<int>(share * length), 0, length);
    return "[" + std::string(static_cast<std::size_t>(filled), '#') +
           std::string(static_cast<std::size_t>(length - filled), '.') + "] ";
}

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

std::string progress_line(const RenderProgress& progress, int columns) {
    const int room = std::max(columns - 1, 0);
    const std::string percent = formatted("%5.1f %%", 100 * std::clamp(progress.done, 0.0, 1.0));
    const std::string left =
        progress.seconds_left ? "  " + time_text(*progress.seconds_left) + " left" : std::string();
    const std::string error =
        progress.error ? formatted("  error %.2g %%", 100 * *progress.error) : std::string();
    for (const std::string& words :
         {percent + rate_text(progress) + error + left, percent + error + left, percent + left}) {
        const int bar = std::min(room - static_cast<int>(words.size()) - 3, kLongestBar);
        if (bar >= kShortestBar) return bar_text(progress.done, bar) + words;
    }
    for (const std::string& words : {percent + left, percent}) {
        if (static_cast<int>(words.size()) <= room) return words;
    }
    return {};
}

void ProgressPrinter::print(const RenderProgress& progress) {
    using Stage = RenderProgress::Stage;
    const bool ends = progress.stage == Stage::finished || progress.stage == Stage::cancelled;
    if (options_.report_interval > 0)
        print_report(progress);
    else if (options_.bar && ends)
        std::fputs("\r\033[K", stderr);
    else if (options_.bar && progress.stage == Stage::running)
        std::fprintf(stderr, "\r\033[K%s", progress_line(progress, terminal_columns()).c_str());
    if (progress.stage != Stage::running) warnings_.use_terminal_line(options_.bar && !ends);
}

void ProgressPrinter::print_report(const RenderProgress& progress) const {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::array<char, 256> host{};
    if (gethostname(host.data(), host.size() - 1) != 0) host.front() = '\0';
    std::fprintf(stderr, "%s: %llu rays, %4.2f%% after %.3fu %.3fs %.3fr hours on %s (PID %ld)\n",
                 options_.program.c_str(), static_cast<unsigned long long>(progress.rays),
                 100 * progress.done, hours(used.ru_utime), hours(used.ru_stime),
                 progress.seconds / 3600, host.data(), static_cast<long>(getpid()));
}

}  // namespace lightwalk
