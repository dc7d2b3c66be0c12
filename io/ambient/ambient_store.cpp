#include "io/ambient/ambient_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>

#include "io/files/record_log.h"

namespace lightwalk {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& doing) {
    throw InputError({path, 0}, doing + ": " + std::system_category().message(errno));
}

/// Bytes of the file from `begin` to its end.
std::string read_from(int file, std::size_t begin, const std::string& path) {
    std::string bytes;
    std::array<char, 1 << 16> chunk{};
    for (;;) {
        const ssize_t count =
            pread(file, chunk.data(), chunk.size(), static_cast<off_t>(begin + bytes.size()));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(path, "cannot read");
        if (count == 0) return bytes;
        bytes.append(chunk.data(), static_cast<std::size_t>(count));
    }
}

/// See AmbientStore::beginning.
std::string text_of(std::string_view part) {
    return std::to_string(part.size()) + ' ' + std::to_string(fnv1a(part));
}

/// Whether a file begins as text_of has said.
/// @param size  of that part [bytes]
bool begins_with(std::string_view bytes, const std::string& said, std::size_t& size) {
    return std::from_chars(said.data(), said.data() + said.size(), size).ec == std::errc() &&
           size <= bytes.size() && text_of(bytes.substr(0, size)) == said;
}

void write_at(int file, std::size_t begin, const std::string& bytes, const std::string& path) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = pwrite(file, bytes.data() + done, bytes.size() - done,
                                     static_cast<off_t>(begin + done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail(path, "cannot write");
        done += static_cast<std::size_t>(count);
    }
}

}  // namespace

/// The whole file, for this process alone (or shared, for reading).
class AmbientStore::Lock {
  public:
    Lock(int file, bool exclusive, const std::string& path) : file_(file) {
        if (!set(exclusive ? F_WRLCK : F_RDLCK)) fail(path, "cannot lock");
    }
    ~Lock() { (void)set(F_UNLCK); }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

  private:
    bool set(int kind) const {
        struct flock whole {};
        whole.l_type = static_cast<short>(kind);
        whole.l_whence = SEEK_SET;
        int result = -1;
        while ((result = fcntl(file_, F_SETLKW, &whole)) < 0 && errno == EINTR) {
        }
        return result == 0;
    }
    int file_;
};

AmbientStore::AmbientStore(const std::string& path, const RenderOptions& options,
                           AmbientCache& cache, WarningSink& warnings, OthersValues others,
                           const std::string& begun)
    : path_(path), cache_(cache), others_(others) {
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) {
        file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
        writable_ = false;
        if (file_ < 0) fail(path, "cannot open the ambient file");
        warnings.warn(path + ": the ambient file cannot be written; its values are used");
    }
    try {
        const Lock lock(file_, writable_, path_);
        load(options, warnings, begun);
    } catch (...) {
        (void)close(file_);
        throw;
    }
}

AmbientStore::~AmbientStore() {
    (void)close(file_);
}

void AmbientStore::load(const RenderOptions& options, WarningSink& warnings,
                        const std::string& begun) {
    struct stat status {};
    if (fstat(file_, &status) != 0) fail(path_, "cannot read");
    if (!S_ISREG(status.st_mode))
        throw InputError({path_, 0}, "an ambient file must be a plain file");
    std::string bytes = read_from(file_, 0, path_);
    if (bytes.empty() && writable_) {
        bytes = encode_ambient_header({ambient_option_line(options)});
        write_at(file_, 0, bytes, path_);
    }
    AmbientFile contents = decode_ambient_file(bytes, path_);
    fit_.emplace(contents.header, options, cache_.limits());
    known_ = contents.size;
    cut_damage(contents, warnings);
    leave_added(contents, bytes, begun);
    if (!begun.empty() && beginning_ != begun)
        warnings.warn(path_ +
                      ": the ambient file no longer has the values with which this run began: it "
                      "begins anew");
    loaded_ = use(contents.records);
    warn_of_difference(contents.records.size(), warnings);
}

/// Takes the values that the file has got since a run began out of its contents; none where it does
/// not begin as `begun` says.
void AmbientStore::leave_added(AmbientFile& contents, std::string_view bytes,
                               const std::string& begun) {
    const std::size_t header = contents.size - contents.records.size() * kAmbientRecordSize;
    std::size_t size = 0;
    if (!begins_with(bytes.substr(0, contents.size), begun, size) || size < header ||
        (size - header) % kAmbientRecordSize != 0)
        size = contents.size;
    beginning_ = text_of(bytes.substr(0, size));
    for (std::size_t at = size; at < contents.size; at += kAmbientRecordSize) {
        added_.emplace(bytes.substr(at, kAmbientRecordSize));
        contents.records.pop_back();
    }
}

void AmbientStore::warn_of_difference(std::size_t values, WarningSink& warnings) const {
    if (fit_->difference().empty()) return;
    std::string text = path_ + ": the ambient file was made with " + fit_->difference() + ": ";
    text +=
        std::to_string(loaded_.size()) + " of its " + std::to_string(values) + " values are used";
    if (fit_->loses_values() && writable_)
        text += ", and values of more bounces than its own are not stored in it";
    warnings.warn(text);
}

/// The damaged end is cut off.
void AmbientStore::cut_damage(const AmbientFile& contents, WarningSink& warnings) const {
    if (contents.damage.empty()) return;
    warnings.warn(path_ + ": " + contents.damage + "; the " +
                  std::to_string(contents.records.size()) + " values before are used" +
                  (writable_ ? ", the rest is cut off" : ""));
    if (writable_ && ftruncate(file_, static_cast<off_t>(known_)) != 0)
        fail(path_, "cannot cut off the damaged end");
}

/// Take over those that serve; returns them as they are used.
std::vector<AmbientRecord> AmbientStore::use(const std::vector<AmbientRecord>& records) {
    std::vector<AmbientRecord> used;
    for (const AmbientRecord& record : records) {
        const std::optional<AmbientRecord> fitted = fit_->for_run(record);
        if (!fitted) continue;
        cache_.insert(*fitted);
        used.push_back(*fitted);
    }
    return used;
}

/// Whole records that other processes have appended; the file is locked.
void AmbientStore::pass_appended() {
    struct stat status {};
    if (fstat(file_, &status) != 0) fail(path_, "cannot read");
    if (static_cast<std::size_t>(status.st_size) < known_ + kAmbientRecordSize) return;
    const std::string bytes = read_from(file_, known_, path_);
    const AmbientFile contents = decode_ambient_file(encode_ambient_header({}) + bytes, path_);
    if (others_ == OthersValues::taken) (void)use(contents.records);
    known_ += contents.records.size() * kAmbientRecordSize;
}

void AmbientStore::stored(const AmbientRecord& record, std::span<const Rgb> /*groups*/) {
    if (!writable_) return;
    const std::optional<AmbientRecord> kept = fit_->for_file(record);
    if (!kept) return;
    const std::string bytes = encode_ambient_record(*kept);
    const std::lock_guard guard(mutex_);
    if (const auto there = added_.find(bytes); there != added_.end()) {
        added_.erase(there);
        return;
    }
    const Lock lock(file_, true, path_);
    pass_appended();
    write_at(file_, known_, bytes, path_);
    known_ += bytes.size();
}

}  // namespace lightwalk
