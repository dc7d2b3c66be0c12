#pragma once
// A file that has no place in any folder: what processes of one machine hand each other.
#include <span>
#include <string>
#include <string_view>

namespace lightwalk {

/// Bytes in memory that other processes of the same user on this machine can map: each page is
/// there once for all of them. Gone when this and all mappings are.
class MemoryFile {
  public:
    /// @param pieces  one after the other
    /// Throws InputError where there is not enough memory, or the system has no such files.
    explicit MemoryFile(std::span<const std::string_view> pieces);
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    /// To be opened while this object lives.
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    void write(std::string_view bytes) const;

    int descriptor_ = -1;
    std::string path_;
};

}  // namespace lightwalk
