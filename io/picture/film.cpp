#include "io/picture/film.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "io/files/program_path.h"

namespace lightwalk {
namespace {

namespace fs = std::filesystem;

/// While it lives a pipe whose reader has gone is an error for this thread, not a signal that ends
/// the process.
class NoPipeSignal {
  public:
    NoPipeSignal() {
        sigemptyset(&pipe_);
        sigaddset(&pipe_, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
    }
    ~NoPipeSignal() {
        const timespec at_once{};
        (void)sigtimedwait(&pipe_, nullptr, &at_once);  // the one that was held up
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    NoPipeSignal(const NoPipeSignal&) = delete;
    NoPipeSignal& operator=(const NoPipeSignal&) = delete;

  private:
    sigset_t pipe_{}, before_{};
};

bool write_all(int descriptor, const char* bytes, std::size_t count) {
    const NoPipeSignal quiet;
    while (count > 0) {
        const ssize_t n = ::write(descriptor, bytes, count);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes += n;
        count -= static_cast<std::size_t>(n);
    }
    return true;
}

std::vector<std::string> encoder_line(const std::string& encoder, int width, int height,
                                      double rate, const std::string& file) {
    std::stringstream options;
    options << "-nostdin -hide_banner -loglevel error -y -f rawvideo -pix_fmt rgb24 -s " << width
            << 'x' << height << " -framerate " << rate
            << " -i pipe:0 -an"
            // Half the resolution of colours is what every player can show; that wants even sides.
            << " -vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -pix_fmt yuv420p -movflags +faststart -f mp4";
    std::vector<std::string> words{encoder};
    for (std::string word; options >> word;) words.push_back(word);
    words.push_back("file:" + file);
    return words;
}

}  // namespace

bool is_film(const std::string& path) {
    const std::string extension = fs::path(path).extension().string();
    return extension == ".mp4" || extension == ".MP4";
}

std::string film_encoder() {
    std::string program = program_path("ffmpeg");
    if (!program.empty()) return program;
    throw InputError(
        "films are encoded by the program ffmpeg, which is not installed: install it, or write "
        "pictures (-o frame%04d.png)");
}

Film::Film(std::string path, int width, int height, double rate,
           std::function<void(const std::string& path)> unfinished)
    : path_(std::move(path)), width_(width), height_(height), unfinished_(std::move(unfinished)) {
    const std::string encoder = film_encoder();
    part_ = path_ + ".part" + std::to_string(::getpid());
    tell_unfinished(part_);
    start(encoder, rate);
}

void Film::start(const std::string& encoder, double rate) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw InputError({path_, 0}, "cannot open a pipe");
    input_ = ends[1];
    std::vector<std::string> words = encoder_line(encoder, width_, height_, rate, part_);
    std::vector<char*> line;
    line.reserve(words.size() + 1);
    for (std::string& word : words) line.push_back(word.data());
    line.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    // A group of its own: Ctrl-C is ours to answer.
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &pipe);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    const int failed =
        posix_spawn(&process_, encoder.c_str(), &actions, &attributes, line.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    (void)::close(ends[0]);
    if (failed == 0) return;
    process_ = -1;
    (void)::close(input_);
    throw InputError({path_, 0},
                     "cannot start " + encoder + ": " + std::generic_category().message(failed));
}

int Film::wait() {
    if (input_ >= 0) (void)::close(input_);
    input_ = -1;
    int status = -1;
    while (process_ > 0 && ::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
}

Film::~Film() {
    if (process_ > 0) {
        (void)::kill(process_, SIGKILL);
        (void)wait();
    }
    std::error_code ignored;
    if (!part_.empty()) fs::remove(part_, ignored);
    tell_unfinished("");
}

void Film::add(const Picture& picture, const DisplayTone& tone) {
    if (picture.width != width_ || picture.height != height_)
        throw InputError({path_, 0},
                         "the frames of a film are of one size, and these views are not");
    const std::vector<std::array<std::uint8_t, 3>> pixels = display_pixels(picture, tone);
    if (write_all(input_, reinterpret_cast<const char*>(pixels.data()), pixels.size() * 3)) return;
    (void)wait();
    throw InputError({path_, 0}, "ffmpeg has failed");
}

void Film::finish() {
    const int status = wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw InputError({path_, 0}, "ffmpeg has failed");
    std::error_code failed;
    fs::rename(part_, path_, failed);
    if (failed) throw InputError({path_, 0}, "cannot write: " + failed.message());
    part_.clear();
    tell_unfinished("");
}

}  // namespace lightwalk
