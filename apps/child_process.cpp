#include "apps/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr int kTick = 500;                     // [ms]
constexpr std::chrono::seconds kUnheeded{10};  // a sound process notices dead children at once
constexpr std::size_t kLastWords = 16384;      // of standard error [bytes]
constexpr std::size_t kLongestLine = 65536;    // what is longer is handed on [bytes]
constexpr std::size_t kMostPieces = 64;  // at once, lest a flood of words keeps signals waiting

sigset_t child_signals() {
    sigset_t signals{};
    sigemptyset(&signals);
    for (const int signal : {SIGCHLD, SIGINT, SIGTERM}) sigaddset(&signals, signal);
    return signals;
}

struct Pipe {
    FileDescriptor out, in;  ///< to read from, and to write to
};

Pipe make_pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        throw InputError("no pipe: " + std::generic_category().message(errno));
    return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

/// All that is there to be read; calls `take` for each piece of it.
template <class Take>
void read_all(int descriptor, Take take) {
    std::array<char, 4096> piece{};
    for (std::size_t count = 0; count < kMostPieces; ++count) {
        pollfd ready{descriptor, POLLIN, 0};
        if (poll(&ready, 1, 0) <= 0) return;
        const ssize_t size = read(descriptor, piece.data(), piece.size());
        if (size <= 0) return;
        take(std::string_view(piece.data(), static_cast<std::size_t>(size)));
    }
}

void hand_on(std::string_view text, std::FILE* to) {
    (void)std::fwrite(text.data(), 1, text.size(), to);
    (void)std::fflush(to);
}

bool has_ended(const std::string& process) {
    std::ifstream file("/proc/" + process + "/stat");
    std::string text;
    std::getline(file, text, '\0');                 // a process that is gone by now is no exception
    const std::size_t name_end = text.rfind(") ");  // the name itself may have any characters
    return name_end != std::string::npos && text.find_first_of("ZX", name_end) == name_end + 2;
}

/// Whether it has children that have ended, and no others (proc(5): children, stat).
bool has_dead_alone(pid_t process) {
    bool any = false;
    std::error_code error;
    const std::string tasks = "/proc/" + std::to_string(process) + "/task";
    for (std::filesystem::directory_iterator task(tasks, error), end; !error && task != end;
         task.increment(error)) {
        std::ifstream children(task->path() / "children");
        for (std::string child; children >> child; any = true)
            if (!has_ended(child)) return false;
    }
    return any && !error;
}

}  // namespace

bool UnheededEnds::seen(pid_t process) {
    const auto now = std::chrono::steady_clock::now();
    if (!has_dead_alone(process))
        since_.reset();
    else if (!since_)
        since_ = now;
    return since_ && now - *since_ >= kUnheeded;
}

ChildSignals::ChildSignals() {
    const sigset_t signals = child_signals();
    pthread_sigmask(SIG_BLOCK, &signals, &before_);
    descriptor_ = FileDescriptor(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
    if (descriptor_) return;
    const int error = errno;
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    throw InputError("no descriptor for signals: " + std::generic_category().message(error));
}

ChildSignals::~ChildSignals() {
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

ChildProcess::ChildProcess(std::vector<std::string> words, const ChildSignals& signals,
                           Output output)
    : signals_(signals), output_(std::move(output)) {
    std::vector<char*> texts;
    texts.reserve(words.size() + 1);
    for (std::string& word : words) texts.push_back(word.data());
    texts.push_back(nullptr);
    const bool watched = output_.take_line != nullptr;
    Pipe trouble = make_pipe(), out, err;
    if (watched) {
        out = make_pipe();
        err = make_pipe();
    }
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ == 0) {  // only what a signal handler may do, as there may be threads
        pthread_sigmask(SIG_SETMASK, &signals.before(), nullptr);
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (getppid() != parent) _exit(1);
        if (watched) {
            dup2(out.in.get(), STDOUT_FILENO);
            dup2(err.in.get(), STDERR_FILENO);
        }
        execvp(texts[0], texts.data());
        const int error = errno;
        (void)!write(trouble.in.get(), &error, sizeof error);
        _exit(1);
    }
    int error = process_ < 0 ? errno : 0;
    trouble.in = FileDescriptor();
    if (process_ > 0 && read(trouble.out.get(), &error, sizeof error) > 0)
        (void)waitpid(process_, nullptr, 0);
    if (error != 0)
        throw std::system_error(error, std::generic_category(), words[0] + " cannot be started");
    out_ = std::move(out.out);
    err_ = std::move(err.out);
}

ChildProcess::End ChildProcess::wait() {
    End end;
    for (;;) {
        const pid_t ended = waitpid(process_, &end.how, WNOHANG);
        const bool over = ended == process_ || (ended < 0 && errno != EINTR);
        if (out_) take_output();
        if (err_) take_errors(end);
        if (over) break;
        // Of what has reached its end poll() would tell without pause.
        std::array<pollfd, 3> news{
            {{signals_.descriptor(), POLLIN, 0}, {out_.get(), POLLIN, 0}, {err_.get(), POLLIN, 0}}};
        const int found = poll(news.data(), news.size(), kTick);
        if (found > 0 && news[0].revents != 0) take_signal(end);
        if (news[1].revents != 0 && (news[1].revents & POLLIN) == 0) out_ = FileDescriptor();
        if (news[2].revents != 0 && (news[2].revents & POLLIN) == 0) err_ = FileDescriptor();
        if (output_.tick) output_.tick();
        if (!end.hung && ends_.seen(process_)) end.hung = kill(process_, SIGKILL) == 0;
    }
    if (!line_.empty()) hand_on(std::exchange(line_, {}) + '\n', stdout);
    return end;
}

void ChildProcess::take_signal(End& end) const {
    signalfd_siginfo what{};
    if (read(signals_.descriptor(), &what, sizeof what) != sizeof what) return;
    const int signal = static_cast<int>(what.ssi_signo);
    if (signal == SIGCHLD) return;
    end.interrupted = true;
    // Ctrl-C reaches all processes of the terminal's group.
    if (signal == SIGTERM || what.ssi_code == SI_USER) kill(process_, signal);
}

void ChildProcess::take_output() {
    read_all(out_.get(), [this](std::string_view piece) {
        line_ += piece;
        for (std::size_t end = 0; (end = line_.find('\n')) != std::string::npos;) {
            const std::string line = line_.substr(0, end);
            line_.erase(0, end + 1);
            if (!output_.take_line(line)) hand_on(line + '\n', stdout);
        }
        if (line_.size() > kLongestLine) hand_on(std::exchange(line_, {}), stdout);
    });
}

void ChildProcess::take_errors(End& end) const {
    read_all(err_.get(), [&end](std::string_view piece) {
        hand_on(piece, stderr);
        end.last_words += piece;
        if (end.last_words.size() > kLastWords)
            end.last_words.erase(0, end.last_words.size() - kLastWords);
    });
}

}  // namespace lightwalk
