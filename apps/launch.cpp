// lightwalk launch: starts a command on many ranks, and again where a rank or a host is lost.
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/commands.h"
#include "apps/session/lightwalk/ranks.h"
#include "core/error.h"
#include "io/files/file_descriptor.h"
#include "io/files/file_source.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

using Words = std::vector<std::string>;

constexpr int kMostRanks = 1 << 16;
constexpr int kMostRetries = 1000;
constexpr std::chrono::minutes kLongRun{1};  ///< after which retries count anew
constexpr int kAnswerPatience = 5000;        ///< for a host to answer [ms]

struct LaunchCommand {
    int ranks = 0;      ///< --ranks; 0: one for each slot of the hosts
    std::string hosts;  ///< --hosts: file; "": this machine alone
    int retries = 3;    ///< --retries
    std::string more;   ///< --mpirun: words for mpirun
};

OptionTable launch_table(LaunchCommand& c) {
    const Action answered{[] {}};  // by main, wherever they stand
    return {
        {"launch", kLaunch},
        {{{"Ranks", SectionTitle{}},
          {"--ranks N", &c.ranks,
           "number of ranks; 0: as many as the hosts have slots, or as mpirun finds cores",
           With{.least = 0, .most = kMostRanks, .expected = "a number from 0"}},
          {"--hosts FILE", &c.hosts, "a host a line: NAME, or NAME slots=N"},
          {"--retries N", &c.retries,
           "how often the command is started again when a rank or a host has been lost: it goes "
           "on from what is kept, without hosts that do not answer. After a minute without a loss "
           "it counts anew",
           With{.least = 0, .most = kMostRetries, .expected = "a number from 0"}},
          {"--mpirun WORDS", &c.more,
           "more words for mpirun, in one: \"--map-by socket --bind-to socket\""},
          {"Help", SectionTitle{}},
          {"--help", answered, "this text"},
          {"--version", answered, "the version of Lightwalk"}}}};
}

struct Host {
    std::string name;
    int slots = 1;
};

/// Throws InputError, with the line, for what is no host.
std::vector<Host> read_hosts(const std::string& file) {
    std::vector<Host> hosts;
    std::istringstream lines(real_files()->read(file));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::istringstream words(line.substr(0, line.find('#')));
        Host host;
        if (!(words >> host.name)) continue;
        for (std::string word; words >> word;) {
            const std::string slots = "slots=";
            const bool good =
                word.starts_with(slots) &&
                std::sscanf(word.c_str() + slots.size(), "%d", &host.slots) == 1 &&  // NOLINT
                host.slots > 0 && host.slots <= kMostRanks;
            if (!good)
                throw InputError({file, number},
                                 "expected NAME or NAME slots=N, found \"" + word + '"');
        }
        hosts.push_back(host);
    }
    if (hosts.empty()) throw InputError({file, 0}, "names no host");
    return hosts;
}

/// Whether a machine is there: it takes a connection to where ssh listens, or refuses it.
bool answers(const std::string& name) {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (getaddrinfo(name.c_str(), "22", &wanted, &found) != 0) return false;
    bool answered = false;
    for (const addrinfo* at = found; at != nullptr && !answered; at = at->ai_next) {
        const FileDescriptor socket(
            ::socket(at->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        if (!socket) continue;
        int error = connect(socket.get(), at->ai_addr, at->ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS) {
            pollfd waiting{socket.get(), POLLOUT, 0};
            socklen_t size = sizeof error;
            if (poll(&waiting, 1, kAnswerPatience) <= 0 ||
                getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0)
                error = ETIMEDOUT;
        }
        answered = error == 0 || error == ECONNREFUSED;
    }
    freeaddrinfo(found);
    return answered;
}

/// A setting of Open MPI, unless the user has made it.
void set_by_default(const char* name, const char* value) {
    (void)setenv(name, value, 0);  // NOLINT(concurrency-mt-unsafe): there is one thread
}

/// A secret of 128 bits, as 32 hex digits.
std::string make_secret() {
    std::random_device random;
    std::string digits;
    constexpr int kBits = 128;
    for (int i = 0; i < kBits / 4; ++i) digits += "0123456789abcdef"[random() & 15U];
    return digits;
}

/// With these mpirun notices that a host is gone, and a rank that is killed holds no lock.
void settle_mpi() {
    set_by_default("OMPI_MCA_oob_tcp_keepalive_time", "5");
    set_by_default("OMPI_MCA_oob_tcp_keepalive_intvl", "2");
    set_by_default("OMPI_MCA_oob_tcp_keepalive_probes", "2");
    set_by_default("PMIX_MCA_gds", "hash");
}

/// Waits for the process, and hands on to it what would end this one. Sets `interrupted` then.
int wait_for(pid_t process, const sigset_t& signals, bool& interrupted) {
    for (int how = 0;;) {
        const pid_t ended = waitpid(process, &how, WNOHANG);
        if (ended == process || (ended < 0 && errno != EINTR)) return how;
        siginfo_t what{};
        if (sigwaitinfo(&signals, &what) < 0 || what.si_signo == SIGCHLD) continue;
        interrupted = true;
        // Ctrl-C reaches all processes of the terminal's group.
        if (what.si_signo == SIGTERM || what.si_code == SI_USER) kill(process, what.si_signo);
    }
}

class Launch {
  public:
    Launch(LaunchCommand options, Words command)
        : options_(std::move(options)), command_(std::move(command)) {
        std::error_code error;
        program_ = std::filesystem::canonical("/proc/self/exe", error).string();
        if (!options_.hosts.empty()) hosts_ = read_hosts(options_.hosts);
        const bool picture = command_.front() == "render";
        walks_ = command_.front() == "walk";
        can_go_on_ = walks_ || command_.front() == "animate" || (picture && has("--checkpoint"));
        if (walks_ && is_any_port())
            throw UsageError("option --port: expected a number: pages look for it again");
        if (picture && !can_go_on_ && options_.retries > 0)
            throw UsageError("option --retries: expected --checkpoint FILE behind render");
        if (!can_go_on_) options_.retries = 0;
        sigemptyset(&signals_);
        for (const int signal : {SIGCHLD, SIGINT, SIGTERM}) sigaddset(&signals_, signal);
    }

    int run() {
        settle_mpi();
        if (walks_) set_by_default(kWalkToken, make_secret().c_str());
        sigset_t before{};
        pthread_sigmask(SIG_BLOCK, &signals_, &before);
        int status = kFailureStatus;
        bool again = false, interrupted = false;
        for (int retry = 0;; ++retry, again = true) {
            const auto begin = std::chrono::steady_clock::now();
            const int how = wait_for(start(again, before), signals_, interrupted);
            if (std::chrono::steady_clock::now() - begin > kLongRun) retry = 0;
            status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
            const bool done = status == kSuccessStatus || status == kUsageStatus || interrupted;
            if (done || retry == options_.retries || !is_loss(status)) break;
            std::fprintf(stderr, "lightwalk launch: ended with status %d: %s (%d of %d)\n", status,
                         walks_ ? "begins anew" : "goes on", retry + 1, options_.retries);
        }
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
        return status;
    }

  private:
    [[nodiscard]] bool has(const std::string& word) const {
        return std::ranges::find(command_, word) != command_.end();
    }

    [[nodiscard]] bool is_any_port() const {
        const auto at = std::ranges::find(command_, "--port");
        return at != command_.end() && at + 1 != command_.end() && *(at + 1) == "0";
    }

    [[nodiscard]] Words words_of(bool again) const {
        Words words{"mpirun"};
        int slots = 0;
        std::string list;
        for (const Host& host : hosts_) {
            slots += host.slots;
            list += (list.empty() ? "" : ",") + host.name + ':' + std::to_string(host.slots);
        }
        if (!hosts_.empty()) words.insert(words.end(), {"--host", list});
        const int ranks = slots > 0 && options_.ranks > 0 ? std::min(slots, options_.ranks)
                                                          : std::max(slots, options_.ranks);
        if (ranks > 0) words.insert(words.end(), {"-n", std::to_string(ranks)});
        if (!hosts_.empty() && std::getenv("RAYPATH") != nullptr)  // NOLINT: there is one thread
            words.insert(words.end(), {"-x", "RAYPATH"});
        if (!hosts_.empty() && walks_) words.insert(words.end(), {"-x", kWalkToken});
        std::istringstream more(options_.more);
        for (std::string word; more >> word;) words.push_back(word);
        words.insert(words.end(), {program_, command_.front()});
        if (again && !walks_ && !has("--resume")) words.emplace_back("--resume");
        words.insert(words.end(), command_.begin() + 1, command_.end());
        return words;
    }

    /// @param mask  of signals, for the process
    [[nodiscard]] pid_t start(bool again, const sigset_t& mask) const {
        Words words = words_of(again);
        std::vector<char*> texts;
        for (std::string& word : words) texts.push_back(word.data());
        texts.push_back(nullptr);
        posix_spawnattr_t attributes{};
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setsigmask(&attributes, &mask);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
        pid_t process = 0;
        const int error =
            posix_spawnp(&process, texts[0], nullptr, &attributes, texts.data(), environ);
        posix_spawnattr_destroy(&attributes);
        if (error != 0)
            throw InputError("mpirun cannot be started: " + std::generic_category().message(error) +
                             "; it is in Debian's package openmpi-bin");
        return process;
    }

    /// Whether a rank was killed, or a host is gone: these are left out from now on. What ends by
    /// itself with a status of its own would do so again.
    bool is_loss(int status) {
        constexpr int kKilled = 128;
        const std::size_t before = hosts_.size();
        std::erase_if(hosts_, [](const Host& host) {
            if (answers(host.name)) return false;
            std::fprintf(stderr, "lightwalk launch: %s does not answer: goes on without it\n",
                         host.name.c_str());
            return true;
        });
        if (before > 0 && hosts_.empty()) throw InputError({options_.hosts, 0}, "no host answers");
        return status > kKilled || hosts_.size() < before;
    }

    LaunchCommand options_;
    Words command_;
    std::string program_;
    std::vector<Host> hosts_;
    bool can_go_on_ = false, walks_ = false;
    sigset_t signals_{};
};

}  // namespace

OptionTable launch_option_table() {
    return owning_table(LaunchCommand(), launch_table);
}

int run_launch(const std::vector<std::string>& words, Communicator* ranks) {
    if (ranks != nullptr) throw UsageError("starts mpirun by itself: call it without mpirun");
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
