#include "apps/progress_printer.h"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "apps/progress_line.h"

namespace lightwalk {
namespace {

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

void ProgressPrinter::print(const RenderProgress& progress) {
    using Stage = RenderProgress::Stage;
    const bool ends = progress.stage == Stage::finished || progress.stage == Stage::cancelled;
    if (options_.report_interval > 0)
        print_report(progress);
    else if (options_.bar && ends)
        std::fputs("\r\033[K", stderr);
    else if (options_.bar && progress.stage == Stage::running)
        print_bar(progress);
    if (progress.stage != Stage::running) warnings_.use_terminal_line(options_.bar && !ends);
}

void ProgressPrinter::print_bar(const RenderProgress& progress) const {
    const double seconds = std::max(progress.seconds, 1e-3);
    const std::string line = progress_line(
        {progress.done, static_cast<double>(progress.rays) / seconds, progress.seconds_left},
        terminal_columns());
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
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
