#include "apps/serve/scene_server.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/interrupt.h"
#include "apps/serve/served_run.h"
#include "apps/serve/served_words.h"
#include "apps/session/resident_scene.h"
#include "core/error.h"
#include "io/files/file_descriptor.h"

namespace lightwalk {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostServers = 4;  ///< of a user: each holds a scene in memory
constexpr std::size_t kMostRuns = 256;   ///< at once
constexpr int kLookRound = 5000;         ///< how often the files are looked at [ms]

struct Place {
    SceneKey key;
    char folder[kMostServedPath];
    char path[kMostServedPath];  ///< of the socket
};

Place place_of(const std::string& file) {
    Place place;
    char program[4096];
    if (!find_lightwalk(program, sizeof program) ||
        !make_scene_key(program, file.c_str(), environ, place.key) ||
        !served_folder(environ, place.folder) ||
        !served_path(place.folder, place.key.hash, place.path))
        throw InputError({file, 0}, "cannot be served: a path or RAYPATH is too long");
    if (!make_served_folder(place.folder))
        throw InputError({place.folder, 0}, "cannot be used: expected a folder of this user alone");
    return place;
}

/// Keeps others from serving the same scene, for as long as it is open.
FileDescriptor lock_place(const Place& place, const std::string& file) {
    FileDescriptor table(open_served_table(place.folder));
    if (!table) throw InputError({place.folder, 0}, "cannot be written to");
    struct flock range {};
    range.l_type = F_WRLCK;
    range.l_whence = SEEK_SET;
    range.l_start = static_cast<off_t>(place.key.hash >> 2 | std::uint64_t{1} << 61);
    range.l_len = 1;
    if (fcntl(table.get(), F_OFD_SETLK, &range) != 0)
        throw InputError({file, 0}, "is served already");
    return table;
}

/// Removes the sockets that have not been used for longest: their servers see it, and end.
void make_room(const Place& place) {
    std::vector<std::pair<fs::file_time_type, fs::path>> sockets;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(place.folder, error))
        if (entry.is_socket(error)) sockets.emplace_back(entry.last_write_time(error), entry);
    std::ranges::sort(sockets);
    for (std::size_t i = 0; i + kMostServers <= sockets.size(); ++i)
        fs::remove(sockets[i].second, error);
}

/// A socket that others of this user find.
class Entrance {
  public:
    explicit Entrance(const char* path)
        : path_(path),
          socket_(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
        (void)unlink(path);  // of one that was killed: the lock is ours
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strcpy(address.sun_path, path);
        if (!socket_ ||
            bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            listen(socket_.get(), SOMAXCONN) != 0 || stat(path, &state_) != 0)
            throw InputError({path, 0},
                             "cannot be made: " + std::generic_category().message(errno));
        set_interrupt_litter(path_);
    }
    Entrance(const Entrance&) = delete;
    Entrance& operator=(const Entrance&) = delete;
    ~Entrance() {
        if (stands()) (void)unlink(path_.c_str());
    }
    [[nodiscard]] int socket() const { return socket_.get(); }
    /// Whether nobody has removed it.
    [[nodiscard]] bool stands() const {
        struct stat now {};
        return lstat(path_.c_str(), &now) == 0 && now.st_ino == state_.st_ino &&
               now.st_dev == state_.st_dev;
    }
    /// For make_room() of others.
    void note_use() const { (void)utimensat(AT_FDCWD, path_.c_str(), nullptr, 0); }

  private:
    std::string path_;
    FileDescriptor socket_;
    struct stat state_ {};
};

/// A forked process that waits for a socket to whoever asks.
class SpareRun {
  public:
    SpareRun(pid_t process, FileDescriptor way) : process_(process), way_(std::move(way)) {}
    [[nodiscard]] pid_t process() const { return process_; }

    /// Hands it over; false: the process is no more.
    [[nodiscard]] bool take(int asking) const {
        Message message;
        cmsghdr* const header = CMSG_FIRSTHDR(&message.head);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof asking);
        std::memcpy(CMSG_DATA(header), &asking, sizeof asking);
        return sendmsg(way_.get(), &message.head, MSG_NOSIGNAL) > 0;
    }
    /// In the forked process: what take() hands over; -1: nothing, and nothing will come.
    static int wait(int way) {
        Message message;
        if (recvmsg(way, &message.head, MSG_CMSG_CLOEXEC) <= 0) return -1;
        const cmsghdr* const header = CMSG_FIRSTHDR(&message.head);
        int asking = -1;
        if (header != nullptr) std::memcpy(&asking, CMSG_DATA(header), sizeof asking);
        return asking;
    }

  private:
    struct Message {
        Message() {
            head.msg_iov = &part;
            head.msg_iovlen = 1;
            head.msg_control = control;
            head.msg_controllen = sizeof control;
        }
        char byte = 0;
        iovec part{&byte, 1};
        alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
        msghdr head{};
    };
    pid_t process_;
    FileDescriptor way_;
};

class SceneServer {
  public:
    SceneServer(const Place& place, std::shared_ptr<const ResidentScene> scene,
                Clock::duration idle)
        : place_(place), scene_(std::move(scene)), idle_(idle), entrance_(place.path) {
        sigset_t ends{};
        sigemptyset(&ends);
        sigaddset(&ends, SIGCHLD);
        pthread_sigmask(SIG_BLOCK, &ends, nullptr);
        ends_ = FileDescriptor(signalfd(-1, &ends, SFD_CLOEXEC | SFD_NONBLOCK));
        if (!ends_) throw InputError("cannot watch what is served");
    }

    void run() {
        Clock::time_point last = Clock::now();
        while (!runs_.empty() || Clock::now() - last < idle_) {
            if (!spare_) make_spare();
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(last + idle_ - Clock::now());
            const int patience =
                static_cast<int>(std::clamp<std::int64_t>(left.count(), 1, kLookRound));
            pollfd waiting[2] = {{ends_.get(), POLLIN, 0}, {entrance_.socket(), POLLIN, 0}};
            if (poll(waiting, runs_.size() < kMostRuns ? 2 : 1, patience) < 0 && errno != EINTR)
                return;
            see_ends();
            if (!scene_->files_hold() || !entrance_.stands()) return;
            if (waiting[1].revents != 0 && admit()) last = Clock::now();
        }
    }

  private:
    /// Starts the run of one who asks; false: nobody does.
    bool admit() {
        FileDescriptor asking(accept4(entrance_.socket(), nullptr, nullptr, SOCK_CLOEXEC));
        if (!asking) return false;
        entrance_.note_use();
        if (spare_ && spare_->take(asking.get()))
            runs_.emplace(spare_->process(), std::move(asking));
        spare_.reset();
        return true;
    }

    /// A process that has been forked before somebody asks, who need not wait for it.
    void make_spare() {
        int ends[2] = {-1, -1};
        if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) return;
        FileDescriptor ours(ends[0]), theirs(ends[1]);
        const pid_t process = fork();
        if (process == 0) {
            ours = FileDescriptor();
            const int asking = SpareRun::wait(theirs.get());
            if (asking >= 0) serve_run(asking, place_.key, scene_);
            _exit(0);
        }
        if (process > 0) spare_.emplace(process, std::move(ours));
    }

    /// A run says itself how it ended, unless it was killed.
    void see_ends() {
        signalfd_siginfo what{};
        while (read(ends_.get(), &what, sizeof what) > 0) {
        }
        int how = 0;
        for (pid_t run = 0; (run = waitpid(-1, &how, WNOHANG)) > 0;) {
            const auto ended = runs_.find(run);
            if (ended == runs_.end()) continue;
            if (WIFSIGNALED(how)) {
                ServedReply reply;
                reply.kind = ServedReply::killed;
                reply.value = WTERMSIG(how);
                (void)send(ended->second.get(), &reply, sizeof reply, MSG_NOSIGNAL | MSG_DONTWAIT);
            }
            runs_.erase(ended);
        }
    }

    const Place& place_;
    std::shared_ptr<const ResidentScene> scene_;
    Clock::duration idle_;
    Entrance entrance_;
    FileDescriptor ends_;
    std::optional<SpareRun> spare_;
    std::map<pid_t, FileDescriptor> runs_;  ///< by process: the socket to whoever asked
};

/// A fork has but the thread that made it: work that another one does would stay undone.
bool is_alone() {
    std::error_code error;
    const fs::directory_iterator threads("/proc/self/task", error);
    return !error && std::distance(begin(threads), end(threads)) == 1;
}

}  // namespace

int serve_scene(SceneSource source, const std::string& file, std::chrono::duration<double> idle) {
    handle_interrupts();
    const Place place = place_of(file);
    const FileDescriptor lock = lock_place(place, file);
    source.files = {file};
    const auto scene = std::make_shared<const ResidentScene>(std::move(source));
    if (!is_alone())
        throw InputError({file, 0}, "cannot be served: a library has threads of its own");
    make_room(place);
    SceneServer(place, scene, std::chrono::duration_cast<Clock::duration>(idle)).run();
    return 0;
}

}  // namespace lightwalk
