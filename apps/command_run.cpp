#include "apps/command_run.h"

#include <unistd.h>

#include "apps/interrupt.h"
#include "apps/launcher_output.h"
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
    const std::string copies =
        warning_of_copies(communicator != nullptr ? communicator->size() : 1);
    if (!copies.empty()) warnings_.warn(copies);
    forwarded_ = communicator != nullptr && !write_past_launcher();
    for (const std::string& file : {options.stats_file, options.ranks.timeline})
        if (!file.empty()) check_writable(file);  // not once the work is done
}

void CommandRun::use_standard_output() {
    if (forwarded_)
        warnings_.warn(
            "standard output goes through mpirun, which does not say where it cannot write it all: "
            "it may be cut");
}

void CommandRun::join(const RendererOptions& work) {
    // One process keeps a timeline as the only one of several does.
    if (communicator_ == nullptr && !options_.ranks.timeline.empty())
        alone_ = std::move(make_memory_communicators(1).front());
    Communicator* const communicator = alone_ ? alone_.get() : communicator_;
    ranks_ = join_ranks(communicator, options_.ranks, options_.program(), work);
    if (ranks_) options_.set_threads(ranks_->threads());
}

int CommandRun::share_out(FunctionRef<int()> body) {
    if (!ranks_) return body();
    int status = kFailureStatus;
    try {
        ranks_->run([&] { status = body(); });
    } catch (const Aborted& aborted) {  // what is one rank in memory alone
        return aborted.status;
    }
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
