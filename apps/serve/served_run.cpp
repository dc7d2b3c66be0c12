#include "apps/serve/served_run.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/names/named_program.h"

namespace lightwalk {
namespace {

constexpr int kFiles = kServedStreams + 1;  ///< the last one is the current directory
constexpr int kSignals = 31;                ///< those that are not for real-time programs
constexpr time_t kPatience = 2;             ///< for the request [s]

struct Request {
    RequestHead head;
    std::array<int, kFiles> files{};
    std::vector<char> bytes;
    std::string_view key;
    std::vector<std::string> words;  ///< the first is what the program was called by
    std::vector<char*> variables;    ///< in `bytes`, null behind them
};

/// The files that came with a message; none where they are not so many as belong to a request.
bool take_files(msghdr& message, std::array<int, kFiles>& files) {
    const cmsghdr* const header = CMSG_FIRSTHDR(&message);
    if (header == nullptr || header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS ||
        header->cmsg_len != CMSG_LEN(sizeof files))
        return false;
    std::memcpy(files.data(), CMSG_DATA(header), sizeof files);
    return true;
}

/// Splits what is behind the head; false: it is not as it should be.
bool take_texts(Request& request) {
    const RequestHead& head = request.head;
    char* at = request.bytes.data() + sizeof head;
    char* const end = request.bytes.data() + request.bytes.size();
    if (head.key > static_cast<std::size_t>(end - at)) return false;
    request.key = {at, head.key};
    at += head.key;
    const std::uint64_t texts = std::uint64_t{head.words} + head.variables;
    for (std::uint64_t i = 0; i < texts; ++i) {
        char* const zero = std::find(at, end, '\0');
        if (zero == end) return false;
        if (i < head.words)
            request.words.emplace_back(at, zero);
        else
            request.variables.push_back(at);
        at = zero + 1;
    }
    request.variables.push_back(nullptr);
    return at == end && !request.words.empty();
}

std::optional<Request> receive_request(int socket) {
    const timeval patience{kPatience, 0};
    setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    char none = 0;  // tells how many bytes there are
    const ssize_t waiting = recv(socket, &none, sizeof none, MSG_PEEK | MSG_TRUNC);
    if (waiting <= 0 || waiting > static_cast<ssize_t>(kMostRequest)) return {};
    Request request;
    request.bytes.resize(static_cast<std::size_t>(waiting));
    iovec part{request.bytes.data(), request.bytes.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof request.files)> control{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
    const bool whole = (message.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) == 0;
    if (size != waiting || size < static_cast<ssize_t>(sizeof request.head) || !whole ||
        !take_files(message, request.files))
        return {};
    std::memcpy(&request.head, request.bytes.data(), sizeof request.head);
    const bool known =
        std::memcmp(request.head.magic, RequestHead{}.magic, sizeof request.head.magic) == 0;
    if (!known || !take_texts(request)) return {};
    return request;
}

/// Takes over what the system grants the process that asks; false: it cannot be taken over.
bool take_grants(int socket) {
    ucred asking{};
    socklen_t size = sizeof asking;
    if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &asking, &size) != 0 ||
        asking.uid != geteuid() || asking.gid != getegid())
        return false;
    for (int resource = 0; resource < RLIMIT_NLIMITS; ++resource) {
        rlimit theirs{}, ours{};
        const auto kind = static_cast<__rlimit_resource>(resource);
        if (prlimit(asking.pid, kind, nullptr, &theirs) != 0 || getrlimit(kind, &ours) != 0 ||
            theirs.rlim_cur != ours.rlim_cur || theirs.rlim_max != ours.rlim_max)
            return false;
    }
    cpu_set_t processors;
    if (sched_getaffinity(asking.pid, sizeof processors, &processors) != 0 ||
        sched_setaffinity(0, sizeof processors, &processors) != 0 ||
        sched_getscheduler(asking.pid) != sched_getscheduler(0))
        return false;
    const auto process = static_cast<id_t>(asking.pid);
    return setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, process)) == 0;
}

/// Signals act as they would in the program that asks, and its end ends this process.
void take_signals(int socket, const RequestHead& head) {
    for (int number = 1; number <= kSignals; ++number) {
        const bool ignored = (head.ignored >> (number - 1) & 1) != 0;
        if (number != SIGKILL && number != SIGSTOP)
            (void)std::signal(number, ignored ? SIG_IGN : SIG_DFL);
    }
    (void)std::signal(SIGIO, SIG_DFL);
    sigset_t blocked{};
    static_assert(sizeof blocked >= sizeof head.blocked);
    std::memcpy(&blocked, &head.blocked, sizeof head.blocked);
    sigdelset(&blocked, SIGIO);
    pthread_sigmask(SIG_SETMASK, &blocked, nullptr);
    // The socket tells by SIGIO when the other end closes.
    (void)fcntl(socket, F_SETOWN, getpid());
    (void)fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_ASYNC);
}

bool take_streams(Request& request) {
    for (int stream = 0; stream < kServedStreams; ++stream)
        if (dup2(request.files[static_cast<std::size_t>(stream)], stream) < 0) return false;
    if (fchdir(request.files[kServedStreams]) != 0) return false;
    for (const int file : request.files) close(file);
    umask(request.head.mask);
    environ = request.variables.data();
    return true;
}

bool tell(int socket, ServedReply::Kind kind, int value = 0) {
    ServedReply reply;
    reply.kind = kind;
    reply.value = value;
    return send(socket, &reply, sizeof reply, MSG_NOSIGNAL) == sizeof reply;
}

[[noreturn]] void decline(int socket) {
    (void)tell(socket, ServedReply::declined);
    _exit(0);
}

}  // namespace

void serve_run(int socket, const SceneKey& key, const std::shared_ptr<const ResidentScene>& scene) {
    std::optional<Request> request = receive_request(socket);
    if (!request || request->key != std::string_view(key.bytes, key.size) || !take_grants(socket) ||
        !take_streams(*request))
        decline(socket);
    take_signals(socket, request->head);
    if (!tell(socket, ServedReply::begun)) _exit(0);  // it does the work itself by now
    const std::vector<std::string> words(request->words.begin() + 1, request->words.end());
    const int status = run_named_rtrace(scene, words);
    std::fflush(nullptr);
    (void)tell(socket, ServedReply::exited, status);
    _exit(status);  // at once: nobody needs the memory in order
}

}  // namespace lightwalk
