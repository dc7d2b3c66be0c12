#include "apps/serve/served_words.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <initializer_list>

namespace lightwalk {
namespace {

/// Bytes one after the other; what does not fit is not there, and full() says so.
class Appender {
  public:
    Appender(char* bytes, std::size_t room) : at_(bytes), left_(room) {}
    void add(const void* bytes, std::size_t count) {
        if (full_ || count > left_) {
            full_ = true;
            return;
        }
        std::memcpy(at_, bytes, count);
        at_ += count;
        left_ -= count;
    }
    void text(const char* text) { add(text, std::strlen(text)); }
    template <class Number>
    void number(Number value) {
        add(&value, sizeof value);
    }
    [[nodiscard]] bool full() const { return full_; }
    [[nodiscard]] std::size_t left() const { return left_; }

  private:
    char* at_;
    std::size_t left_;
    bool full_ = false;
};

constexpr const char* kMatters[] = {"RAYPATH=", "LD_", "GLIBC_TUNABLES=", "MALLOC_"};

bool matters(const char* variable) {
    if (std::strncmp(variable, kBindAtOnce, std::strlen("LD_BIND_NOW=")) == 0) return false;
    for (const char* const start : kMatters)
        if (std::strncmp(variable, start, std::strlen(start)) == 0) return true;
    return false;
}

const char* value_of(char* const* environment, const char* start) {
    const std::size_t length = std::strlen(start);
    for (; *environment != nullptr; ++environment)
        if (std::strncmp(*environment, start, length) == 0) return *environment + length;
    return nullptr;
}

/// A server counts as work of whoever started it, and ends with it: of a job on a cluster, say.
bool add_control_group(Appender& bytes) {
    const int file = open("/proc/self/cgroup", O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    char text[2048];
    const ssize_t size = read(file, text, sizeof text);
    close(file);
    if (size < 0 || size == sizeof text) return false;
    bytes.add(text, static_cast<std::size_t>(size));
    return true;
}

/// FNV-1a. Source: Fowler, Noll, Vo, "The FNV Non-Cryptographic Hash Algorithm".
std::uint64_t hash_of(const char* bytes, std::size_t size) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (std::size_t i = 0; i < size; ++i)
        hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3;
    return hash;
}

}  // namespace

bool make_scene_key(const char* program, const char* scene, char* const* environment,
                    SceneKey& key) {
    Appender bytes(key.bytes, sizeof key.bytes);
    struct stat state {};
    if (stat(program, &state) != 0) return false;
    bytes.number(state.st_dev);
    bytes.number(state.st_ino);
    bytes.number(state.st_size);
    bytes.number(state.st_mtim);
    // The last one is of the mounts that the process sees: in containers paths mean other files.
    for (const char* const place : {".", "/", "/proc/self/ns/mnt"}) {
        if (stat(place, &state) != 0) return false;
        bytes.number(state.st_dev);
        bytes.number(state.st_ino);
    }
    bytes.add(scene, std::strlen(scene) + 1);
    if (!add_control_group(bytes)) return false;
    for (; *environment != nullptr; ++environment)
        if (matters(*environment)) bytes.add(*environment, std::strlen(*environment) + 1);
    if (bytes.full()) return false;
    key.size = sizeof key.bytes - bytes.left();
    key.hash = hash_of(key.bytes, key.size);
    return true;
}

bool find_lightwalk(char* path, std::size_t size) {
    constexpr char kName[] = "lightwalk";
    const ssize_t length = readlink("/proc/self/exe", path, size - sizeof kName);
    if (length <= 0 || static_cast<std::size_t>(length) >= size - sizeof kName) return false;
    path[length] = 0;
    char* const slash = std::strrchr(path, '/');
    if (slash == nullptr) return false;
    std::memcpy(slash + 1, kName, sizeof kName);
    return true;
}

bool served_folder(char* const* environment, char (&path)[kMostServedPath]) {
    Appender text(path, sizeof path - 1);
    std::memset(path, 0, sizeof path);
    const char* const folder = value_of(environment, "XDG_RUNTIME_DIR=");
    if (folder != nullptr && folder[0] == '/') {
        text.text(folder);
        text.text("/lightwalk");
        return !text.full();
    }
    text.text("/tmp/lightwalk-");
    char digits[16] = {};
    char* first = digits + sizeof digits - 1;
    unsigned user = geteuid();
    do {
        *--first = static_cast<char>('0' + user % 10);
        user /= 10;
    } while (user > 0);
    text.text(first);
    return !text.full();
}

bool make_served_folder(const char* path) {
    (void)mkdir(path, 0700);
    struct stat state {};
    return lstat(path, &state) == 0 && S_ISDIR(state.st_mode) && state.st_uid == geteuid() &&
           (state.st_mode & 077) == 0;
}

int open_served_table(const char* folder) {
    char path[kMostServedPath + sizeof "/seen"];
    std::strcpy(path, folder);
    std::strcat(path, "/seen");
    return open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
}

bool served_path(const char* folder, std::uint64_t hash, char (&path)[kMostServedPath]) {
    std::memset(path, 0, sizeof path);
    Appender text(path, sizeof path - 1);
    text.text(folder);
    text.text("/");
    for (int digit = 15; digit >= 0; --digit)
        text.add(&"0123456789abcdef"[hash >> (4 * digit) & 15], 1);
    return !text.full();
}

}  // namespace lightwalk
