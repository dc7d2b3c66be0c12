#include "io/files/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/error.h"

namespace lightwalk {
namespace {

[[noreturn]] void refuse_memory_file(int code) {
    throw InputError("no memory to share: " + std::system_category().message(code));
}

}  // namespace

MemoryFile::MemoryFile(std::span<const std::string_view> pieces)
    : descriptor_(::memfd_create("lightwalk", MFD_CLOEXEC)) {
    if (descriptor_ < 0) refuse_memory_file(errno);
    path_ = "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(descriptor_);
    try {
        for (const std::string_view piece : pieces) write(piece);
    } catch (...) {
        (void)::close(descriptor_);
        throw;
    }
}

MemoryFile::~MemoryFile() {
    (void)::close(descriptor_);
}

void MemoryFile::write(std::string_view bytes) const {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) refuse_memory_file(written < 0 ? errno : ENOSPC);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

}  // namespace lightwalk
