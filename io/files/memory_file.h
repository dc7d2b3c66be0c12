#pragma once
// An anonymous file in memory, through which processes of one machine share bytes.
#include <span>
#include <string>
#include <string_view>

namespace lightwalk {

/// Bytes in memory that other processes of the same user on this machine can map; all of them share
/// each page. The memory is freed when this object and all mappings are gone.
class MemoryFile {
  public:
    /// @param pieces  their concatenation is the contents
    /// Throws InputError where there is not enough memory, or the system has no such files.
    explicit MemoryFile(std::span<const std::string_view> pieces);
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    /// A path by which processes can open the file while this object lives.
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    void write(std::string_view bytes) const;

    int descriptor_ = -1;
    std::string path_;
};

}  // namespace lightwalk
