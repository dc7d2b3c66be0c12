// The program behind the name rtrace where scenes are served: asks the server that holds the octree
// to trace the rays, with its own standard input and output. Where there is none, or the server
// declines, it becomes lightwalk, which does all by itself. Without C++'s library: it runs
// thousands of times.
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include "apps/serve/served_words.h"

namespace lightwalk {
namespace {

constexpr int kPatience = 5000;  ///< for a server to begin [ms]
constexpr int kSignals = 64;
constexpr std::size_t kMostVariables = 4096;  ///< of a server's environment

struct Question {
    char program[4096];
    char folder[kMostServedPath];
    char path[kMostServedPath];  ///< of the socket
    const char* scene;
    SceneKey key;
};

void say(const char* text) {
    (void)!write(STDERR_FILENO, text, std::strlen(text));
}

bool starts_with(const char* text, const char* start) {
    return std::strncmp(text, start, std::strlen(start)) == 0;
}

/// Whether words or variables say that only this process can do the work: files by the numbers that
/// it knows them by, or ranks.
bool is_bound_to_process(char* const* words, char* const* environment) {
    for (; *words != nullptr; ++words)
        for (const char* const place : {"/dev/fd", "/dev/tty", "/proc/"})
            if (std::strstr(*words, place) != nullptr) return true;
    for (; *environment != nullptr; ++environment)
        for (const char* const rank : {"OMPI_COMM_WORLD_SIZE=", "PMIX_RANK=", "PMI_RANK="})
            if (starts_with(*environment, rank)) return true;
    return false;
}

/// A terminal is for the processes of its own session.
bool has_streams() {
    for (int stream = 0; stream < kServedStreams; ++stream)
        if (fcntl(stream, F_GETFD) < 0) return false;
    termios settings{};
    return tcgetattr(STDIN_FILENO, &settings) != 0;
}

/// The scene is the last word, if the words are those of rtrace with an octree.
bool prepare(int count, char* const* words, char* const* environment, Question& question) {
    if (count < 2) return false;
    const char* const slash = std::strrchr(words[0], '/');
    if (std::strcmp(slash != nullptr ? slash + 1 : words[0], "rtrace") != 0) return false;
    question.scene = words[count - 1];
    if (question.scene[0] == 0 || std::strchr("-!@$", question.scene[0]) != nullptr) return false;
    return has_streams() && !is_bound_to_process(words, environment) &&
           make_scene_key(question.program, question.scene, environment, question.key) &&
           served_folder(environment, question.folder) &&
           served_path(question.folder, question.key.hash, question.path);
}

// A server that is to be.

/// Whether this is the second run on the octree: one alone is not worth a server. A table in a file
/// has a place for each octree, which those that differ in the rest of the hash share.
bool is_second_run(const Question& question) {
    constexpr std::uint64_t kPlaces = 256;
    const int file = open_served_table(question.folder);
    if (file < 0) return false;
    const auto place = static_cast<off_t>(question.key.hash % kPlaces * sizeof question.key.hash);
    std::uint64_t seen = 0;
    const bool again =
        pread(file, &seen, sizeof seen, place) == sizeof seen && seen == question.key.hash;
    // Who starts it takes it out, so that others do not start another one meanwhile.
    const std::uint64_t next = again ? 0 : question.key.hash;
    const bool written = pwrite(file, &next, sizeof next, place) == sizeof next;
    close(file);
    return again && written;
}

[[noreturn]] void become_server(Question& question, char* const* environment) {
    const int nothing = open("/dev/null", O_RDWR);
    for (int stream = 0; stream < kServedStreams; ++stream) dup2(nothing, stream);
    (void)close_range(kServedStreams, ~0U, 0);
    for (int number = 1; number <= kSignals; ++number) (void)signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    pthread_sigmask(SIG_SETMASK, &none, nullptr);
    char name[] = "lightwalk", command[] = "trace", serve[] = "--serve";
    char* const words[] = {name, command, serve, const_cast<char*>(question.scene), nullptr};
    static char bind_at_once[sizeof kBindAtOnce];  // NOLINT: what follows may not allocate
    static char* variables[kMostVariables];        // NOLINT
    std::memcpy(bind_at_once, kBindAtOnce, sizeof kBindAtOnce);
    std::size_t count = 0;
    variables[count++] = bind_at_once;
    for (; *environment != nullptr && count < kMostVariables - 1; ++environment)
        variables[count++] = *environment;
    if (*environment == nullptr) execve(question.program, words, variables);
    _exit(1);
}

/// Starts a server beside this run, for those that follow. It has nothing of this process but the
/// directory and the environment.
void offer_server(Question& question, char* const* environment) {
    const std::size_t length = std::strlen(question.scene);
    struct stat state {};
    if (length < 5 || std::strcmp(question.scene + length - 4, ".oct") != 0 ||
        stat(question.scene, &state) != 0 || !S_ISREG(state.st_mode) ||
        !make_served_folder(question.folder) || !is_second_run(question))
        return;
    const pid_t between = fork();
    if (between < 0) return;
    if (between == 0) {
        setsid();
        if (fork() == 0) become_server(question, environment);
        _exit(0);
    }
    while (waitpid(between, nullptr, 0) < 0 && errno == EINTR) {
    }
}

// The server that is there.

/// Nothing: -1.
int connect_to(const Question& question, char* const* environment) {
    const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket < 0) return -1;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, question.path);
    ucred server{};
    socklen_t size = sizeof server;
    if (connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
        getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &server, &size) == 0 && server.uid == geteuid())
        return socket;
    const bool absent = errno == ENOENT || errno == ECONNREFUSED;
    close(socket);
    if (absent) offer_server(const_cast<Question&>(question), environment);
    return -1;
}

std::uint64_t ignored_signals() {
    std::uint64_t ignored = 0;
    for (int number = 1; number < 32; ++number) {
        struct sigaction action {};
        if (sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN)
            ignored |= std::uint64_t{1} << (number - 1);
    }
    return ignored;
}

/// @return  bytes; 0: they are too many
std::size_t write_request(const SceneKey& key, char* const* words, char* const* environment,
                          char* bytes) {
    RequestHead head;
    head.key = static_cast<std::uint32_t>(key.size);
    head.mask = umask(0);
    umask(head.mask);
    head.ignored = ignored_signals();
    sigset_t blocked;
    pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
    std::memcpy(&head.blocked, &blocked, sizeof head.blocked);
    std::size_t size = sizeof head;
    std::memcpy(bytes + size, key.bytes, key.size);
    size += key.size;
    const auto add = [&](char* const* texts, std::uint32_t& count) {
        for (; *texts != nullptr; ++texts, ++count) {
            const std::size_t length = std::strlen(*texts) + 1;
            if (length > kMostRequest - size) return false;
            std::memcpy(bytes + size, *texts, length);
            size += length;
        }
        return true;
    };
    if (!add(words, head.words) || !add(environment, head.variables)) return 0;
    std::memcpy(bytes, &head, sizeof head);
    return size;
}

bool send_request(int socket, const Question& question, char* const* words,
                  char* const* environment) {
    static char bytes[kMostRequest];  // NOLINT: too large for a stack, and zero until it is used
    const int folder = open(".", O_PATH | O_DIRECTORY | O_CLOEXEC);
    iovec part{bytes, write_request(question.key, words, environment, bytes)};
    if (folder < 0 || part.iov_len == 0) return false;
    const int files[kServedStreams + 1] = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO, folder};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof files)] = {};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof files);
    std::memcpy(CMSG_DATA(header), files, sizeof files);
    const bool sent = sendmsg(socket, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(part.iov_len);
    close(folder);
    return sent;
}

/// Waits; false: nothing came, or no reply.
bool receive(int socket, int patience, ServedReply& reply) {
    pollfd waiting{socket, POLLIN, 0};
    int ready = 0;
    while ((ready = poll(&waiting, 1, patience)) < 0 && errno == EINTR) {
    }
    return ready > 0 && recv(socket, &reply, sizeof reply, 0) == sizeof reply;
}

[[noreturn]] void end_as(const ServedReply& reply) {
    if (reply.kind == ServedReply::exited) _exit(reply.value);
    const rlimit no_core{0, 0};  // it would show this program
    setrlimit(RLIMIT_CORE, &no_core);
    (void)signal(reply.value, SIG_DFL);
    sigset_t own;
    sigemptyset(&own);
    sigaddset(&own, reply.value);
    pthread_sigmask(SIG_UNBLOCK, &own, nullptr);
    kill(getpid(), reply.value);
    _exit(128 + reply.value);
}

/// Returns where nobody has begun to trace the rays.
void ask_server(const Question& question, char* const* words, char* const* environment) {
    const int socket = connect_to(question, environment);
    if (socket < 0) return;
    ServedReply reply;
    if (!send_request(socket, question, words, environment)) {
        close(socket);
        return;
    }
    bool begun = receive(socket, kPatience, reply) && reply.kind == ServedReply::begun;
    if (!begun) {
        // From here on it cannot begin; it may have, just now.
        shutdown(socket, SHUT_RD);
        begun = receive(socket, 0, reply) && reply.kind == ServedReply::begun;
        close(socket);
        if (!begun) return;
        say("rtrace: fatal - the server of the octree began too late: try again\n");
        _exit(1);
    }
    if (receive(socket, -1, reply)) end_as(reply);
    say("rtrace: fatal - the server of the octree has ended\n");
    _exit(1);
}

}  // namespace
}  // namespace lightwalk

int main(int count, char** words, char** environment) {
    static lightwalk::Question question;  // NOLINT: see send_request()
    if (!lightwalk::find_lightwalk(question.program, sizeof question.program)) {
        lightwalk::say("lightwalk: cannot tell where the program is\n");
        return 1;
    }
    if (lightwalk::prepare(count, words, environment, question))
        lightwalk::ask_server(question, words, environment);
    execve(question.program, words, environment);
    lightwalk::say("lightwalk: cannot start the program\n");
    return 1;
}
