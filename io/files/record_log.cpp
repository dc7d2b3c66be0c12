#include "io/files/record_log.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "io/files/library_path.h"

namespace lightwalk {
namespace {

constexpr std::string_view kFirstLine = "lightwalk log 1\n";
constexpr std::string_view kMark = "LWRC";
constexpr std::size_t kHeadBytes = 4 + 8 + 8;  ///< mark, size, hash
constexpr std::size_t kLargestLog = std::size_t{1} << 34;

[[noreturn]] void fail_at(const std::string& path, const std::string& what) {
    throw InputError({path, 0}, what + ": " + std::generic_category().message(errno));
}

std::uint64_t number_at(std::string_view bytes, std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// Size of the record at the beginning of `bytes`, head included; 0: there is no whole one.
std::size_t record_size(std::string_view bytes) {
    if (bytes.size() < kHeadBytes || bytes.substr(0, kMark.size()) != kMark) return 0;
    const std::uint64_t size = number_at(bytes, 4);
    if (size > bytes.size() - kHeadBytes) return 0;
    const std::string_view payload = bytes.substr(kHeadBytes, size);
    return fnv1a(payload) == number_at(bytes, 12) ? kHeadBytes + payload.size() : 0;
}

void write_all(int file, std::string_view bytes, const std::string& path) {
    while (!bytes.empty()) {
        const ssize_t written = write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail_at(path, "cannot write");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// Lines of `text` up to the first empty one, which is not among them.
std::string_view header_of(std::string_view text) {
    const std::size_t end = text.find("\n\n");
    return end == std::string_view::npos ? text : text.substr(0, end + 1);
}

void check_header(std::string_view found, std::string_view expected, const std::string& path) {
    std::int32_t line = 1;
    while (!found.empty() || !expected.empty()) {
        ++line;
        const auto next = [](std::string_view& text) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            const std::string_view first = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            return std::string(first);
        };
        const std::string a = next(found), b = next(expected);
        if (a != b) {
            throw InputError({path, line}, "the file belongs to another run: it says \"" + a +
                                               "\", this run \"" + b + '"');
        }
    }
}

/// Hands out the whole records at the beginning of `rest`, and returns what follows them.
std::string_view take_records(std::string_view rest,
                              const std::function<void(std::string_view)>& take) {
    while (const std::size_t size = record_size(rest)) {
        take(rest.substr(kHeadBytes, size - kHeadBytes));
        rest.remove_prefix(size);
    }
    return rest;
}

}  // namespace

std::uint64_t fnv1a(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    return hash;
}

RecordLog::RecordLog(std::string path, const std::string& header,
                     const std::function<void(std::string_view)>& take, WarningSink& warnings)
    : path_(std::move(path)) {
    const std::string head = std::string(kFirstLine) + header + '\n';
    file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) fail_at(path_, "cannot open");
    try {
        start(head, header, take, warnings);
    } catch (...) {
        (void)close(file_);
        throw;
    }
}

void RecordLog::start(const std::string& head, const std::string& header,
                      const std::function<void(std::string_view)>& take, WarningSink& warnings) {
    if (flock(file_, LOCK_EX | LOCK_NB) != 0)
        throw InputError({path_, 0}, "another run is writing this file");
    std::size_t whole = 0;
    if (is_readable_file(path_)) {
        const std::string bytes = read_file(path_, kLargestLog);
        std::string_view rest = bytes;
        if (head.starts_with(rest)) rest = {};  // killed while it was made
        if (!rest.empty() && !rest.starts_with(kFirstLine))
            throw InputError({path_, 1}, "not a log of this program");
        if (!rest.empty()) {
            rest.remove_prefix(kFirstLine.size());
            const std::string_view found = header_of(rest);
            check_header(found, header, path_);
            rest.remove_prefix(std::min(rest.size(), found.size() + 1));
            rest = take_records(rest, take);
            whole = static_cast<std::size_t>(rest.data() - bytes.data());
            if (!rest.empty())
                warnings.warn(path_ + ": the last " + std::to_string(rest.size()) +
                              " bytes are damaged and cut off");
        }
    }
    if (ftruncate(file_, static_cast<off_t>(whole)) != 0)
        fail_at(path_, "cannot cut off a damaged end");
    if (lseek(file_, 0, SEEK_END) < 0) fail_at(path_, "cannot write");
    if (whole == 0) write_all(file_, head, path_);
}

void RecordLog::look_through(const std::string& path,
                             const std::function<void(std::string_view)>& take) {
    if (!is_readable_file(path)) return;
    const std::string bytes = read_file(path, kLargestLog);
    std::string_view rest = bytes;
    if (!rest.starts_with(kFirstLine)) return;
    rest.remove_prefix(std::min(
        rest.size(), kFirstLine.size() + header_of(rest.substr(kFirstLine.size())).size() + 1));
    (void)take_records(rest, take);
}

RecordLog::~RecordLog() {
    if (file_ >= 0) (void)close(file_);
}

void RecordLog::append(std::string_view payload) {
    const std::uint64_t size = payload.size(), hash = fnv1a(payload);
    std::string record(kMark);
    record.append(reinterpret_cast<const char*>(&size), sizeof size);
    record.append(reinterpret_cast<const char*>(&hash), sizeof hash);
    record += payload;
    write_all(file_, record, path_);
}

void RecordLog::sync() {
    if (fdatasync(file_) != 0) fail_at(path_, "cannot write");
}

void RecordLog::remove() {
    (void)unlink(path_.c_str());
}

}  // namespace lightwalk
