#include "apps/command_run.h"

#include <unistd.h>

#include "apps/interrupt.h"
#include "io/files/atomic_file.h"

namespace lightwalk {
namespace {

/// Append messages to the file that -e names.
void redirect_messages(const std::string& file, const std::string& history) {
    if (file.empty()) return;
    if (std::freopen(file.c_str(), "a", stderr) == nullptr)
        throw InputError({file, 0}, "cannot open the error file");
    std::fprintf(stderr, "**************\n*** PID %ld: %s\n", static_cast<long>(getpid()),
                 history.c_str());
}

}  // namespace

CommandRun::CommandRun(CommonOptions& options, Communicator* communicator)
    : options_(options), communicator_(communicator), warnings_(options.program()) {
    redirect_messages(options.error_file, options.request.history);
    warnings_.enable(options.settings.warnings && !options.quiet && speaks());
    check_render_settings(options.settings);
    for (const std::string& notice : options.notices) warnings_.warn(notice);
    if (!speaks()) return;
    for (const std::string& file : {options.stats_file, options.ranks.timeline})
        if (!file.empty()) check_writable(file);  // not once the work is done
}

void CommandRun::join(const RendererOptions& work) {
    ranks_ = join_ranks(communicator_, options_.ranks, options_.program(), work);
    if (ranks_) options_.set_threads(ranks_->threads());
}

int CommandRun::share_out(FunctionRef<int()> body) {
    if (!ranks_) return body();
    int status = kFailureStatus;
    ranks_->run([&] { status = body(); });
    return status;
}

RendererRequest CommandRun::request() {
    RendererRequest request = options_.request;
    request.options = renderer_options(options_);
    request.options.warn = [this](const std::string& message) { warnings_.warn(message); };
    return request;
}

void CommandRun::save_statistics(RunStatistics statistics) const {
    statistics.command = options_.command;
    if (!options_.stats_file.empty())
        write_file_atomically(options_.stats_file, statistics_json(statistics));
    if (!statistics.reports.empty() && !options_.ranks.timeline.empty())
        write_file_atomically(options_.ranks.timeline, timeline_json(statistics.reports));
}

void write_to_stdout(const std::string& bytes) {
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    if (!whole || std::fflush(stdout) != 0) throw InputError("cannot write standard output");
}

}  // namespace lightwalk
