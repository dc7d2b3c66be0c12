#include "io/files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>

#include "core/error.h"

namespace lightwalk {
namespace {

namespace fs = std::filesystem;

constexpr int kMostAttempts = 100;

InputError write_error(const std::string& path, int code) {
    return InputError({path, 0}, "cannot write: " + std::generic_category().message(code));
}

/// An open file descriptor.
class OpenFile {
  public:
    explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() {
        if (descriptor_ >= 0) (void)::close(descriptor_);
    }
    /// Error number, or 0.
    int write(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) return errno;
            bytes.remove_prefix(static_cast<std::size_t>(n));
        }
        return 0;
    }
    int write(std::span<const std::string_view> pieces) {
        for (const std::string_view piece : pieces) {
            if (const int failed = write(piece); failed != 0) return failed;
        }
        return 0;
    }
    int close() {
        const int failed = ::close(descriptor_);
        descriptor_ = -1;
        return failed == 0 ? 0 : errno;
    }

  private:
    int descriptor_;
};

/// A file that vanishes again unless it was kept.
class TemporaryFile {
  public:
    explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove(path_, ignored);
    }
    int rename_to(const fs::path& target) {
        if (std::rename(path_.c_str(), target.c_str()) != 0) return errno;
        path_.clear();
        return 0;
    }

  private:
    fs::path path_;
};

/// The open descriptor that a name stands for; nothing for names of other files.
std::optional<int> descriptor_named(const std::string& path) {
    if (path == "/dev/stdout") return STDOUT_FILENO;
    if (path == "/dev/stderr") return STDERR_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!path.starts_with(folder)) continue;
        int number = -1;
        const char* const end = path.data() + path.size();
        const auto [rest, error] = std::from_chars(path.data() + folder.size(), end, number);
        if (error == std::errc() && rest == end) return number;
    }
    return std::nullopt;
}

/// To where the process writes already: behind what it has written, also where that is a file.
void write_to_descriptor(const std::string& path, int descriptor,
                         std::span<const std::string_view> pieces) {
    OpenFile file(::fcntl(descriptor, F_DUPFD_CLOEXEC, 0));
    int failed = file.write(pieces);
    if (failed == 0) failed = file.close();
    if (failed != 0) throw write_error(path, failed);
}

/// Devices and pipes can't be replaced by renaming.
void write_directly(const std::string& path, std::span<const std::string_view> pieces) {
    OpenFile file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    int failed = file.write(pieces);
    if (failed == 0) failed = file.close();
    if (failed != 0) throw write_error(path, failed);
}

/// Whether the name stands for something that is there and is no file, as a device or a pipe.
bool is_special(const std::string& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The file that a name stands for, behind links.
fs::path linked_file(const std::string& path) {
    std::error_code ignored;
    if (!fs::is_symlink(path, ignored)) return path;
    fs::path real = fs::weakly_canonical(path, ignored);
    return real.empty() ? fs::path(path) : real;
}

/// A new file beside the one that is to be written.
class NewFile {
  public:
    /// Throws InputError, which names `path`.
    NewFile(const std::string& path, const fs::path& target) {
        int descriptor = -1;
        fs::path name;
        for (int attempt = 0; descriptor < 0 && attempt < kMostAttempts; ++attempt) {
            name = target;
            name += ".part" + std::to_string(::getpid()) + '-' + std::to_string(attempt);
            descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor < 0 && errno != EEXIST) break;
        }
        if (descriptor < 0) throw write_error(path, errno);
        part_.emplace(std::move(name));
        file_.emplace(descriptor);
    }
    /// Error number, or 0.
    int write(std::span<const std::string_view> pieces, const fs::path& target) {
        int failed = file_->write(pieces);
        if (failed == 0) failed = file_->close();
        return failed == 0 ? part_->rename_to(target) : failed;
    }

  private:
    std::optional<TemporaryFile> part_;
    std::optional<OpenFile> file_;
};

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
    write_file_atomically(path, std::span(&bytes, 1));
}

void write_file_atomically(const std::string& path, std::span<const std::string_view> pieces) {
    if (const std::optional<int> descriptor = descriptor_named(path))
        return write_to_descriptor(path, *descriptor, pieces);
    if (is_special(path)) return write_directly(path, pieces);
    const fs::path target = linked_file(path);
    NewFile file(path, target);
    if (const int failed = file.write(pieces, target); failed != 0) throw write_error(path, failed);
}

void check_writable(const std::string& path) {
    std::error_code ignored;
    if (const std::optional<int> descriptor = descriptor_named(path)) {
        if (::fcntl(*descriptor, F_GETFD) < 0) throw write_error(path, errno);
    } else if (is_special(path)) {
        if (::access(path.c_str(), W_OK) != 0) throw write_error(path, errno);
    } else if (fs::is_directory(path, ignored)) {
        throw write_error(path, EISDIR);
    } else {
        const NewFile made_and_removed(path, linked_file(path));
    }
}

}  // namespace lightwalk
