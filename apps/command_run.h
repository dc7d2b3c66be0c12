#pragma once
// What the commands that render (render, animate, walk, trace) do alike around their own work.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/common_options.h"
#include "apps/rad_command.h"
#include "apps/rank_options.h"
#include "apps/session/run_statistics.h"
#include "apps/warnings.h"
#include "parallel/comm/communicator.h"

namespace lightwalk {

/// Messages, ranks and statistics of a command's run, once its command line is understood.
class CommandRun {
  public:
    CommandRun(const CommandRun&) = delete;
    CommandRun& operator=(const CommandRun&) = delete;

  protected:
    /// From here on messages go where -e says. Throws UsageError, InputError.
    /// @param options       must outlive this
    /// @param communicator  to the other ranks; null: this process is alone
    CommandRun(CommonOptions& options, Communicator* communicator);
    ~CommandRun() = default;

    /// Whether this process is alone, or rank 0.
    [[nodiscard]] bool speaks() const {
        return communicator_ == nullptr || communicator_->rank() == 0;
    }
    /// What the command makes goes to standard output. Warns where nobody can know whether it
    /// arrives.
    void use_standard_output();
    /// Whether a launcher copies standard output.
    [[nodiscard]] bool output_is_forwarded() const { return forwarded_; }
    /// This process becomes one of several, if there are others to share such work with.
    void join(const RendererOptions& work);
    /// After join(): calls `body` on every rank.
    int share_out(FunctionRef<int()> body);
    /// Null: this process is alone.
    [[nodiscard]] Ranks* ranks() const { return ranks_.get(); }
    /// What the options ask for.
    [[nodiscard]] RendererRequest request();
    [[nodiscard]] StderrWarnings& warnings() { return warnings_; }
    /// Writes the files of --stats and --timeline.
    void save_statistics(RunStatistics statistics) const;

  private:
    CommonOptions& options_;
    Communicator* communicator_;
    StderrWarnings warnings_;
    bool forwarded_ = false;
    std::unique_ptr<Communicator> alone_;  ///< see join()
    std::unique_ptr<Ranks> ranks_;
};

/// Bytes to standard output, at once. Throws InputError.
void write_to_stdout(const std::string& bytes);

/// Understands a command line on every rank (see parse_on_ranks), and does what it says: prints the
/// options' values, or makes a `Run(command, ranks, files)`, whose errors are those of the command
/// line, and calls its run().
/// @param command  with the defaults of its options, which option_table(command, files) sets
/// @param ranks    to the other ranks; null: this process is alone
template <class Run, class Command>
int run_command(Command command, const std::vector<std::string>& words, Communicator* ranks) {
    std::optional<Run> run;
    const auto parse = [&](const std::shared_ptr<FileSource>& files) {
        const OptionTable table = take_command_line(command, words, files);
        command.common.words = words;
        if (!command.common.show_defaults)
            run.emplace(command, ranks, *files);
        else if (ranks == nullptr || ranks->rank() == 0)
            std::fputs(table.defaults().c_str(), stdout);
    };
    parse_on_ranks(ranks, command.common.program(), parse);
    return run ? run->run() : kSuccessStatus;
}

}  // namespace lightwalk
