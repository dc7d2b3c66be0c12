#include "apps/launch_hosts.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "io/files/file_descriptor.h"
#include "io/files/file_source.h"

namespace lightwalk {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kBetweenLooks{2};
constexpr std::chrono::milliseconds kPatienceOfLook{1000};

/// @param file  its name, for messages
LaunchHosts parse_hosts(const std::string& text, const std::string& file) {
    LaunchHosts hosts;
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::istringstream words(line.substr(0, line.find('#')));
        LaunchHost host;
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

/// One host that is asked, at the first of its addresses.
class Question {
  public:
    explicit Question(const std::string& name) {
        addrinfo wanted{};
        wanted.ai_socktype = SOCK_STREAM;
        addrinfo* found = nullptr;
        if (getaddrinfo(name.c_str(), "22", &wanted, &found) != 0) return;
        const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
        for (const addrinfo* at = found; at != nullptr && !waits_ && !answered_; at = at->ai_next) {
            socket_ = FileDescriptor(
                ::socket(at->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
            if (!socket_) continue;
            const int error = connect(socket_.get(), at->ai_addr, at->ai_addrlen) == 0 ? 0 : errno;
            answered_ = is_answer(error);
            waits_ = error == EINPROGRESS;
        }
    }

    [[nodiscard]] bool answered() const { return answered_; }
    /// What to poll() for.
    [[nodiscard]] pollfd awaited() const { return {waits_ ? socket_.get() : -1, POLLOUT, 0}; }
    void take_answer() {
        waits_ = false;
        int error = ETIMEDOUT;
        socklen_t size = sizeof error;
        answered_ =
            getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &error, &size) == 0 && is_answer(error);
    }
    [[nodiscard]] bool waits() const { return waits_; }

  private:
    static bool is_answer(int error) { return error == 0 || error == ECONNREFUSED; }

    FileDescriptor socket_;
    bool waits_ = false, answered_ = false;
};

void wait_for_answers(std::vector<Question>& questions, std::chrono::milliseconds patience) {
    const Clock::time_point end = Clock::now() + patience;
    while (std::ranges::any_of(questions, &Question::waits)) {
        std::vector<pollfd> awaited;
        awaited.reserve(questions.size());
        for (const Question& question : questions) awaited.push_back(question.awaited());
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
        if (left.count() <= 0) return;
        if (poll(awaited.data(), awaited.size(), static_cast<int>(left.count())) <= 0) continue;
        for (std::size_t i = 0; i < questions.size(); ++i)
            if (awaited[i].revents != 0) questions[i].take_answer();
    }
}

bool holds(const LaunchHosts& hosts, const std::string& name) {
    return std::ranges::find(hosts, name, &LaunchHost::name) != hosts.end();
}

}  // namespace

LaunchHosts read_launch_hosts(const std::string& file) {
    return parse_hosts(real_files()->read(file), file);
}

LaunchHosts answering(const LaunchHosts& hosts, std::chrono::milliseconds patience) {
    std::vector<Question> questions;
    questions.reserve(hosts.size());
    for (const LaunchHost& host : hosts) questions.emplace_back(host.name);
    wait_for_answers(questions, patience);
    LaunchHosts there;
    for (std::size_t i = 0; i < hosts.size(); ++i)
        if (questions[i].answered()) there.push_back(hosts[i]);
    return there;
}

HostWatch::HostWatch(std::string file, LaunchHosts used)
    : file_(std::move(file)), wanted_(used), used_(std::move(used)) {
    thread_ = std::thread([this] { run(); });
}

HostWatch::~HostWatch() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    news_.notify_one();
    thread_.join();
}

std::optional<LaunchHosts> HostWatch::better() const {
    const std::lock_guard lock(mutex_);
    return Clock::now() < not_before_ ? std::nullopt : better_;
}

void HostWatch::use(const LaunchHosts& hosts, std::chrono::milliseconds pause) {
    const std::lock_guard lock(mutex_);
    used_ = hosts;
    better_.reset();
    not_before_ = Clock::now() + pause;
}

void HostWatch::run() {
    std::unique_lock lock(mutex_);
    while (!news_.wait_for(lock, kBetweenLooks, [this] { return over_; })) {
        const LaunchHosts used = used_;
        lock.unlock();
        std::optional<LaunchHosts> found = look();
        lock.lock();
        if (used == used_) better_ = std::move(found);
    }
}

/// A file that cannot be read is as it was: somebody may be writing it.
void HostWatch::read_file() {
    std::string text;
    try {
        text = real_files()->read(file_);
    } catch (const InputError&) {
        return;
    }
    if (text == text_) return;
    text_ = text;
    try {
        wanted_ = parse_hosts(text, file_);
    } catch (const InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
}

std::optional<LaunchHosts> HostWatch::look() {
    read_file();
    LaunchHosts used;
    {
        const std::lock_guard lock(mutex_);
        used = used_;
    }
    if (wanted_ == used) return std::nullopt;
    LaunchHosts unused;
    for (const LaunchHost& host : wanted_)
        if (!holds(used, host.name)) unused.push_back(host);
    const LaunchHosts there = answering(unused, kPatienceOfLook);
    LaunchHosts next;
    for (const LaunchHost& host : wanted_)
        if (holds(used, host.name) || holds(there, host.name)) next.push_back(host);
    return next.empty() || next == used ? std::nullopt : std::optional(next);
}

}  // namespace lightwalk
