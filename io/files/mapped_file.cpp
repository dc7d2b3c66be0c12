#include "io/files/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace lightwalk {
namespace {

/// A descriptor for as long as a file is being mapped: the mapping outlives it.
class MappingDescriptor {
  public:
    // Without waiting: a pipe may have no writer, and is refused anyway.
    explicit MappingDescriptor(const std::string& path)
        : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
    ~MappingDescriptor() {
        if (number_ >= 0) (void)::close(number_);
    }
    MappingDescriptor(const MappingDescriptor&) = delete;
    MappingDescriptor& operator=(const MappingDescriptor&) = delete;
    [[nodiscard]] int number() const { return number_; }

  private:
    int number_;
};

[[noreturn]] void refuse_mapping(const std::string& path, int code) {
    throw InputError({path, 0}, "cannot open: " + std::system_category().message(code));
}

}  // namespace

MappedFile::MappedFile(std::string path) : path_(std::move(path)) {
    const MappingDescriptor file(path_);
    if (file.number() < 0) refuse_mapping(path_, errno);
    struct stat status {};
    if (::fstat(file.number(), &status) != 0) refuse_mapping(path_, errno);
    if (S_ISDIR(status.st_mode)) throw InputError({path_, 0}, "cannot open: is a directory");
    if (!S_ISREG(status.st_mode)) throw InputError({path_, 0}, "cannot open: no regular file");
    if (status.st_size <= 0) throw InputError({path_, 0}, "is empty");
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const memory = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number(), 0);
    if (memory == MAP_FAILED) refuse_mapping(path_, errno);
    data_ = static_cast<const std::byte*>(memory);
    size_ = size;
}

MappedFile::~MappedFile() {
    // munmap takes what mmap gave, which was not const.
    if (data_ != nullptr) (void)::munmap(const_cast<std::byte*>(data_), size_);
}

}  // namespace lightwalk
