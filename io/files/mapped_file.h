#pragma once
// A memory-mapped file: pages are read on first access, and shared by all processes that map it.
#include <cstddef>
#include <span>
#include <string>

namespace lightwalk {

/// A regular file, mapped for reading. If somebody truncates the file meanwhile the process is
/// killed (SIGBUS); if somebody replaces it by renaming, as write_file_atomically does, the mapped
/// contents stay.
class MappedFile {
  public:
    /// Throws InputError for a file that does not exist, cannot be opened, is not regular, or is
    /// empty.
    explicit MappedFile(std::string path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    /// The contents; the address is a multiple of the page size.
    [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    std::string path_;
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace lightwalk
