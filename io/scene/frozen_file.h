#pragma once
// The container format of frozen scenes: a memory-mapped file of parts.
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

/// A part of a frozen file. `kind` is the kind of data; `owner` distinguishes several parts of one
/// kind, e.g. those of different models.
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

/// Write a frozen file atomically. Parts are written without a copy; no two may have the same kind
/// and owner. Throws InputError.
void write_frozen_file(const std::string& path, std::span<const FrozenPart> parts);

/// A frozen file in memory that processes can share.
[[nodiscard]] std::shared_ptr<const MemoryFile> frozen_memory_file(
    std::span<const FrozenPart> parts);

/// The bytes of a frozen file.
[[nodiscard]] std::string frozen_file_bytes(std::span<const FrozenPart> parts);

/// A frozen file whose header and table have been validated: parts do not overlap and lie inside
/// the file. Spans of its bytes are valid as long as this object. For any number of threads.
class FrozenFile {
  public:
    /// Throws InputError for a file that is no frozen file, is damaged or truncated, or was written
    /// by another version of Lightwalk or on another kind of machine.
    explicit FrozenFile(const std::shared_ptr<const MappedFile>& file);
    /// A frozen file in memory, at an address that is a multiple of 8; `owner` keeps the memory,
    /// and `name` is used in messages.
    FrozenFile(std::shared_ptr<const void> owner, std::span<const std::byte> bytes,
               std::string name);

    [[nodiscard]] bool has(std::uint32_t kind, std::uint32_t owner = 0) const;
    /// The bytes of a part, at an address that is a multiple of 8. All of them are read to verify
    /// the digest; throws InputError if it differs, and if there is no such part.
    [[nodiscard]] std::span<const std::byte> part(std::uint32_t kind,
                                                  std::uint32_t owner = 0) const;

    [[nodiscard]] const std::string& name() const { return name_; }
    /// A digest of all parts: files with equal digests have equal parts.
    [[nodiscard]] std::uint64_t digest() const;
    /// The owner of the memory.
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

/// `bytes` with all digests and sizes in its header and table corrected: for tests of how damage
/// that no digest reveals is handled.
[[nodiscard]] std::string resealed(std::string bytes);

}  // namespace lightwalk
