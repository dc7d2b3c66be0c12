#pragma once
// A file as memory: its pages are read when they are looked at, and shared by all who map it.
#include <cstddef>
#include <span>
#include <string>

namespace lightwalk {

/// A regular file, mapped for reading. Who shortens the file meanwhile ends the process (SIGBUS);
/// who replaces it by renaming, as write_file_atomically does, leaves the mapped one as it is.
class MappedFile {
  public:
    /// Throws InputError for what is not there, cannot be opened, is no regular file, or is empty.
    explicit MappedFile(std::string path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    /// Begins at a page.
    [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    std::string path_;
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace lightwalk
