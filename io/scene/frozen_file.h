#pragma once
// The container of a frozen scene: parts of bytes in one file, mapped rather than read.
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "io/files/mapped_file.h"
#include "io/files/memory_file.h"

namespace lightwalk {

/// One part: `kind` says what it holds, `owner` of what, for kinds of which there are several.
struct FrozenPart {
    std::uint32_t kind = 0, owner = 0;
    std::span<const std::byte> bytes;
};

/// Layout, in numbers as the machine has them: a header of 64 bytes (the word "lwfrozen"; byte
/// order mark u32; format version u32; Lightwalk's version, 16 bytes; size of the file, number of
/// parts, digest of the table, digest of the header so far, u64 each), the table (kind and owner
/// u32, offset, size and digest u64, for each part), then the parts, each from a multiple of 64
/// bytes on. Digests are digest_of_bytes().
inline constexpr std::string_view kFrozenMark = "lwfrozen";
inline constexpr std::size_t kFrozenAlignment = 64;

/// The whole file, or none; parts are written from where they lie. No two may have the same kind
/// and owner. Throws InputError.
void write_frozen_file(const std::string& path, std::span<const FrozenPart> parts);

/// The same in memory that processes share.
[[nodiscard]] std::shared_ptr<const MemoryFile> frozen_memory_file(
    std::span<const FrozenPart> parts);

/// The same bytes in memory.
[[nodiscard]] std::string frozen_file_bytes(std::span<const FrozenPart> parts);

/// A frozen file whose header and table are sound: parts lie inside it, one behind the other. What
/// it hands out lives as long as it does. For any number of threads.
class FrozenFile {
  public:
    /// Throws InputError for a file that is none, is damaged or cut short, or was written by
    /// another version of Lightwalk or on another kind of machine.
    explicit FrozenFile(const std::shared_ptr<const MappedFile>& file);
    /// Bytes in memory that `owner` keeps, from a multiple of 8 on; messages call them `name`.
    FrozenFile(std::shared_ptr<const void> owner, std::span<const std::byte> bytes,
               std::string name);

    [[nodiscard]] bool has(std::uint32_t kind, std::uint32_t owner = 0) const;
    /// The bytes of a part, from a multiple of 8 on, after a look at all of them: throws InputError
    /// where they do not have the part's digest, or there is none.
    [[nodiscard]] std::span<const std::byte> part(std::uint32_t kind,
                                                  std::uint32_t owner = 0) const;

    [[nodiscard]] const std::string& name() const { return name_; }
    /// Of all parts: those of two files with the same digest are the same.
    [[nodiscard]] std::uint64_t digest() const;
    /// What keeps the bytes.
    [[nodiscard]] const std::shared_ptr<const void>& owner() const { return owner_; }

  private:
    struct Place {
        std::span<const std::byte> bytes;
        std::uint64_t digest = 0;
    };
    void read_table(std::size_t parts);

    std::shared_ptr<const void> owner_;
    std::span<const std::byte> bytes_;
    std::string name_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Place> parts_;  ///< by kind and owner
};

/// `bytes`, damaged in any way, with all digests and sizes as its header and table need them to be
/// taken: for tests of what comes behind the digests.
[[nodiscard]] std::string resealed(std::string bytes);

}  // namespace lightwalk
