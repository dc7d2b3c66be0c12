// lightwalk launch: starts a command on many ranks, and again where a rank or a host is lost.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <regex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/child_process.h"
#include "apps/commands.h"
#include "apps/head/walk_head.h"
#include "apps/launch_hosts.h"
#include "apps/rank_starter.h"
#include "apps/session/lightwalk/ranks.h"
#include "apps/walk_command.h"
#include "core/error.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

using Words = std::vector<std::string>;

constexpr int kMostRetries = 1000;
constexpr std::chrono::minutes kLongRun{1};         ///< after which retries count anew
constexpr std::chrono::seconds kAnswerPatience{5};  ///< for a host to answer
constexpr std::chrono::seconds kPause{5};           ///< nobody moves so long: hosts may be taken in
constexpr std::chrono::milliseconds kRest{10'000};  ///< after hosts that could not be taken in
constexpr std::chrono::milliseconds kLongestRest{600'000};

struct LaunchCommand {
    int ranks = 0;                       ///< --ranks; 0: one for each slot of the hosts
    std::string hosts;                   ///< --hosts: file; "": this machine alone
    int retries = 3;                     ///< --retries
    std::string mpirun, srun;            ///< further words for these
    std::optional<RankStarter> starter;  ///< by which of these options is there
};

void choose(LaunchCommand& command, RankStarter starter) {
    if (command.starter.value_or(starter) != starter)
        throw UsageError("option --srun: not together with --mpirun");
    command.starter = starter;
}

OptionTable launch_table(LaunchCommand& c) {
    const Action answered{[] {}};  // by main, wherever they stand
    return {
        {"launch", kLaunch},
        {{{"Ranks", SectionTitle{}},
          {"--ranks N", &c.ranks,
           "number of ranks; 0: as many as the hosts have slots, or as mpirun finds cores",
           With{.least = 0, .most = kMostRanks, .expected = "a number from 0"}},
          {"--hosts FILE", &c.hosts,
           "a host a line: NAME, or NAME slots=N. A walk takes in hosts that are added to the "
           "file, "
           "and those that answer again, when nobody has moved for five seconds; what else is "
           "launched takes them in when it is started again"},
          {"--retries N", &c.retries,
           "how often the command is started again when a rank or a host has been lost: it goes "
           "on from what is kept, without hosts that do not answer. After a minute without a loss "
           "it counts anew",
           With{.least = 0, .most = kMostRetries, .expected = "a number from 0"}},
          {"--mpirun WORDS", &c.mpirun,
           "more words for mpirun, in one: \"--map-by socket --bind-to socket\"",
           With{.then = [&c] { choose(c, RankStarter::mpirun); }}},
          {"--srun WORDS", &c.srun,
           "ranks are started by Slurm's srun, with more words for it, in one: \"--mpi=pmi2\", or "
           "\"\". That is so without the option, too, in a job of Slurm's, unless there is "
           "--mpirun",
           With{.then = [&c] { choose(c, RankStarter::srun); }}},
          {"Help", SectionTitle{}},
          {"--help", answered, "this text"},
          {"--version", answered, "the version of Lightwalk"}}}};
}

/// A secret of 128 bits, as 32 hex digits.
std::string make_secret() {
    std::random_device random;
    std::string digits;
    constexpr int kBits = 128;
    for (int i = 0; i < kBits / 4; ++i) digits += "0123456789abcdef"[random() & 15U];
    return digits;
}

/// What `walk` says of who may open its page, by its words.
WebServerOptions server_options(const Words& words) {
    ServeCommand serve;
    const OptionTable table({"walk", kWalk}, {serve_option_rows(serve)});
    OptionWords line(words);
    while (line.at_option())
        if (!table.take(line)) line.skip(1);
    serve.server.token = std::getenv(kWalkToken);  // NOLINT: there is one thread
    return serve.server;
}

std::string joined(const Words& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
    return text;
}

Words names_without(const LaunchHosts& hosts, const LaunchHosts& others) {
    Words names;
    for (const LaunchHost& host : hosts)
        if (std::ranges::find(others, host.name, &LaunchHost::name) == others.end())
            names.push_back(host.name);
    return names;
}

std::string change_words(const LaunchHosts& before, const LaunchHosts& now) {
    const Words gone = names_without(before, now), come = names_without(now, before);
    std::string words;
    if (!come.empty()) words = joined(come) + (come.size() > 1 ? " are" : " is") + " there";
    if (!come.empty() && !gone.empty()) words += ", ";
    if (!gone.empty())
        words += joined(gone) + (gone.size() > 1 ? " are" : " is") + " not to be used any more";
    return words.empty() ? "hosts have other slots" : words;
}

/// Where a walk's ranks keep what they know for those that may have to begin anew, on this machine.
class KeptFolder {
  public:
    KeptFolder() {
        std::error_code unknown;
        path_ = (std::filesystem::temp_directory_path(unknown) / "lightwalk-XXXXXX").string();
        if (mkdtemp(path_.data()) == nullptr) path_.clear();
    }
    ~KeptFolder() {
        std::error_code failed;
        if (!path_.empty()) std::filesystem::remove_all(path_, failed);
    }
    KeptFolder(const KeptFolder&) = delete;
    KeptFolder& operator=(const KeptFolder&) = delete;

    /// "": nowhere, and then nothing is kept.
    [[nodiscard]] std::string file() const { return path_.empty() ? "" : path_ + "/picture"; }

  private:
    std::string path_;
};

class Launch {
  public:
    Launch(LaunchCommand options, Words command)
        : options_(std::move(options)), command_(std::move(command)) {
        std::error_code error;
        program_ = std::filesystem::canonical("/proc/self/exe", error).string();
        starter_ = options_.starter ? *options_.starter : usual_starter();
        if (!options_.hosts.empty()) hosts_ = read_launch_hosts(options_.hosts);
        const bool picture = command_.front() == "render";
        walks_ = command_.front() == "walk";
        can_go_on_ = walks_ || command_.front() == "animate" || (picture && has("--checkpoint"));
        if (picture && !can_go_on_ && options_.retries > 0)
            throw UsageError("option --retries: expected --checkpoint FILE behind render");
        if (!can_go_on_) options_.retries = 0;
    }

    int run() {
        settle_starter(starter_);
        const ChildSignals signals;
        if (walks_) open_head();
        for (int retry = 0;;) {
            const auto begin = std::chrono::steady_clock::now();
            const ChildProcess::End end = run_once(signals, begun_++ > 0);
            const bool was_long = std::chrono::steady_clock::now() - begin > kLongRun;
            if (was_long) retry = 0;
            const int status = WIFEXITED(end.how) ? WEXITSTATUS(end.how) : 128 + WTERMSIG(end.how);
            if (end.interrupted) return head_ && head_->failed() ? kFailureStatus : status;
            if (exchange_hosts(ready_ || was_long)) continue;
            const bool done = status == kSuccessStatus || status == kUsageStatus;
            if (done || retry == options_.retries) return status;
            const std::string loss = find_loss(end, status);
            if (loss.empty()) return status;
            tell(loss,
                 " (" + std::to_string(++retry) + " of " + std::to_string(options_.retries) + ')');
        }
    }

  private:
    [[nodiscard]] bool has(const std::string& word) const {
        return std::ranges::find(command_, word) != command_.end();
    }

    [[nodiscard]] bool is_by_srun() const { return starter_ == RankStarter::srun; }
    [[nodiscard]] std::string starter_name() const { return is_by_srun() ? "srun" : "mpirun"; }

    /// From here on there are several threads.
    void open_head() {
        kept_.emplace();
        (void)setenv(kWalkKept, kept_->file().c_str(), 1);   // NOLINT: there is one thread
        (void)setenv(kWalkToken, make_secret().c_str(), 0);  // NOLINT: the same
        (void)setenv(kWalkHead, machine_name().c_str(), 1);  // NOLINT: there is one thread
        head_.emplace(server_options({command_.begin() + 1, command_.end()}), "starting the ranks");
        if (!hosts_.empty()) watch_.emplace(options_.hosts, hosts_);
        std::printf("%s\n", head_->url().c_str());
        std::fflush(stdout);
    }

    [[nodiscard]] int ranks() const {
        int slots = 0;
        for (const LaunchHost& host : hosts_) slots += host.slots;
        return slots > 0 && options_.ranks > 0 ? std::min(slots, options_.ranks)
                                               : std::max(slots, options_.ranks);
    }

    [[nodiscard]] Words words_of(bool again) const {
        RanksToStart what{ranks(), hosts_, {}, is_by_srun() ? options_.srun : options_.mpirun};
        if (!hosts_.empty() && std::getenv("RAYPATH") != nullptr)  // NOLINT: nobody writes it
            what.variables.emplace_back("RAYPATH");
        if (walks_) what.variables.insert(what.variables.end(), {kWalkToken, kWalkHead, kWalkKept});
        Words words = starter_words(starter_, what);
        words.insert(words.end(), {program_, command_.front()});
        if (again && !walks_ && !has("--resume")) words.emplace_back("--resume");
        words.insert(words.end(), command_.begin() + 1, command_.end());
        return words;
    }

    ChildProcess::End run_once(const ChildSignals& signals, bool again) {
        ready_ = pausing_ = false;
        std::optional<ChildProcess> run;
        ChildProcess::Output output;
        if (walks_) output.take_line = [this](std::string_view line) { return meet(line); };
        if (watch_) output.tick = [this, &run] { take_in(*run); };
        try {
            run.emplace(words_of(again), signals, std::move(output));
        } catch (const std::system_error& error) {
            const bool missing = error.code() == std::errc::no_such_file_or_directory;
            throw InputError(error.what() + (missing ? "; " + starter_package(starter_) : ""));
        }
        ChildProcess::End end = run->wait();
        if (end.hung)
            std::fprintf(stderr,
                         "lightwalk launch: %s hung when its ranks had ended, and was killed\n",
                         starter_name().c_str());
        return end;
    }

    /// Whether rank 0 says where its web server is: "http://HOST:PORT/?token=TOKEN".
    bool meet(std::string_view line) {
        static const std::regex kAddress(R"(http://([^/:]+):(\d+)/\?token=(\S+))");
        const std::string text(line);
        std::smatch found;
        if (ready_ || !std::regex_search(text, found, kAddress)) return false;
        ready_ = true;
        // mpirun's rank 0 is on the first host, whose name in the list is one that is known here.
        const bool here = found[1] == "127.0.0.1" || hosts_.empty() || is_by_srun();
        head_->begin_run(here ? found[1].str() : hosts_.front().name,
                         static_cast<std::uint16_t>(std::stoul(found[2].str())), found[3].str());
        return true;
    }

    /// Ends the run where there are other hosts to go on with, and nobody would mind.
    void take_in(const ChildProcess& run) {
        if (pausing_ || !ready_ || head_->quiet() < kPause) return;
        std::optional<LaunchHosts> better = watch_->better();
        if (!better) return;
        next_ = std::move(*better);
        pausing_ = true;
        run.terminate();
    }

    /// After a run's end: whether the next one is on other hosts, without any loss.
    bool exchange_hosts(bool came_up) {
        if (pausing_) {
            before_ = std::exchange(hosts_, next_);
            watch_->use(hosts_);
            tell(change_words(before_, hosts_));
            return true;
        }
        const LaunchHosts before = std::exchange(before_, {});
        if (came_up) rest_ = kRest;
        if (came_up || before.empty()) return false;
        const Words come = names_without(hosts_, before);
        hosts_ = before;
        if (watch_) watch_->use(hosts_, rest_);
        rest_ = std::min(2 * rest_, kLongestRest);
        tell("no ranks can be started" + (come.empty() ? "" : " on " + joined(come)));
        return true;
    }

    /// Who is lost; "": nobody, and what ended by itself would do so again. Hosts that do not
    /// answer are left out from now on, and those that do are taken in.
    std::string find_loss(const ChildProcess::End& end, int status) {
        constexpr int kKilled = 128;
        const Words gone = hosts_.empty() ? Words() : leave_out_lost();
        if (!gone.empty()) return joined(gone) + (gone.size() > 1 ? " are lost" : " is lost");
        // srun ends with any status where a host is gone.
        std::string loss;
        if (status > kKilled || is_by_srun()) loss = told_loss(starter_, end.last_words);
        if (!loss.empty() || status <= kKilled) return loss;
        return WIFSIGNALED(end.how) ? starter_name() + " was killed"
                                    : "ended with status " + std::to_string(status);
    }

    /// Their names.
    Words leave_out_lost() {
        const LaunchHosts there = answering(wanted_hosts(), kAnswerPatience);
        Words gone = names_without(hosts_, there);
        for (const std::string& name : gone)
            std::fprintf(stderr, "lightwalk launch: %s does not answer: goes on without it\n",
                         name.c_str());
        if (there.empty()) throw InputError({options_.hosts, 0}, "no host answers");
        if (!names_without(there, hosts_).empty()) {
            before_ = hosts_;
            std::erase_if(before_, [&](const LaunchHost& host) {
                return std::ranges::find(gone, host.name) != gone.end();
            });
        }
        hosts_ = there;
        if (watch_) watch_->use(hosts_);
        return gone;
    }

    /// Those of the file, as it is now; those in use, where it cannot be read.
    [[nodiscard]] LaunchHosts wanted_hosts() const {
        try {
            return read_launch_hosts(options_.hosts);
        } catch (const InputError& error) {
            std::fprintf(stderr, "%s\n", error.what());
            return hosts_;
        }
    }

    /// The user, and whoever sees the page.
    void tell(const std::string& why, const std::string& count = {}) {
        std::string next = "goes on";
        if (walks_) {
            next = "the walk begins anew";
            if (ranks() > 0) next += " with " + std::to_string(ranks()) + " ranks";
            head_->end_run(why + ": " + next);
        }
        std::fprintf(stderr, "lightwalk launch: %s: %s%s\n", why.c_str(), next.c_str(),
                     count.c_str());
    }

    LaunchCommand options_;
    RankStarter starter_ = RankStarter::mpirun;
    Words command_;
    std::string program_;
    LaunchHosts hosts_;   ///< in use
    LaunchHosts next_;    ///< to go on with, once this run has ended
    LaunchHosts before_;  ///< to go back to, where no run comes up on those in use
    std::chrono::milliseconds rest_ = kRest;  ///< after that, until hosts are taken in again
    int begun_ = 0;                           ///< number of runs
    bool can_go_on_ = false, walks_ = false;
    bool ready_ = false;    ///< the run's web server is there
    bool pausing_ = false;  ///< the run ends as other hosts are there
    std::optional<KeptFolder> kept_;
    std::optional<WalkHead> head_;
    std::optional<HostWatch> watch_;
};

}  // namespace

OptionTable launch_option_table() {
    return owning_table(LaunchCommand(), launch_table);
}

int run_launch(const std::vector<std::string>& words, Communicator* ranks) {
    if (ranks != nullptr)
        throw UsageError("starts ranks by itself: call it without mpirun or srun");
    LaunchCommand command;
    const OptionTable table = launch_table(command);
    OptionWords line(words);
    while (line.at_option() && line.option().starts_with('-'))
        if (!table.take(line)) table.refuse(line);
    const Words rest = line.rest();
    const Command* const launched = rest.empty() ? nullptr : find_command(rest.front());
    if (launched == nullptr || !launched->shared)
        throw UsageError("expected a command that runs on ranks: render, animate, trace, contrib");
    return Launch(command, rest).run();
}

}  // namespace lightwalk
