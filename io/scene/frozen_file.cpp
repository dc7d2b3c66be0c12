#include "io/scene/frozen_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/digest.h"

namespace lightwalk {
namespace {

constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr std::uint32_t kFormatVersion = 4;
constexpr std::size_t kVersionLength = 16;

struct FrozenHeader {
    std::array<char, 8> mark{};
    std::uint32_t byte_order = kByteOrder;
    std::uint32_t format = kFormatVersion;
    std::array<char, kVersionLength> software{};  ///< zero bytes fill it up
    std::uint64_t file_size = 0, part_count = 0;
    std::uint64_t table_digest = 0;
    std::uint64_t digest = 0;  ///< digest of the members above
};
static_assert(sizeof(FrozenHeader) == 64);

struct FrozenEntry {
    std::uint32_t kind = 0, owner = 0;
    std::uint64_t offset = 0, size = 0, digest = 0;
};
static_assert(sizeof(FrozenEntry) == 32);

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class T>
std::string_view memory_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string_view table_text(std::span<const FrozenEntry> table) {
    return text_of(std::as_bytes(table));
}

std::uint64_t header_digest(const FrozenHeader& header) {
    return digest_of_bytes(memory_of(header).substr(0, offsetof(FrozenHeader, digest)));
}

std::array<char, kVersionLength> software_version() {
    static_assert(sizeof LIGHTWALK_VERSION <= kVersionLength);
    std::array<char, kVersionLength> version{};
    std::memcpy(version.data(), LIGHTWALK_VERSION, sizeof LIGHTWALK_VERSION);
    return version;
}

std::uint64_t aligned(std::uint64_t offset) {
    return (offset + kFrozenAlignment - 1) / kFrozenAlignment * kFrozenAlignment;
}

std::uint64_t end_of_table(std::uint64_t parts) {
    return sizeof(FrozenHeader) + parts * sizeof(FrozenEntry);
}

/// Where the parts go, and what they are.
std::vector<FrozenEntry> table_of(std::span<const FrozenPart> parts) {
    std::vector<FrozenEntry> table;
    std::uint64_t end = end_of_table(parts.size());
    for (const FrozenPart& part : parts) {
        const std::uint64_t offset = aligned(end);
        table.push_back({part.kind, part.owner, offset, part.bytes.size(),
                         digest_of_bytes(text_of(part.bytes))});
        end = offset + part.bytes.size();
    }
    return table;
}

FrozenHeader header_of(std::span<const FrozenEntry> table) {
    FrozenHeader header;
    std::memcpy(header.mark.data(), kFrozenMark.data(), kFrozenMark.size());
    header.software = software_version();
    header.part_count = table.size();
    header.file_size = table.empty() ? sizeof header : table.back().offset + table.back().size;
    header.table_digest = digest_of_bytes(table_text(table));
    header.digest = header_digest(header);
    return header;
}

/// Gives `use` the whole file, in pieces.
template <class Use>
void in_pieces(std::span<const FrozenPart> parts, const Use& use) {
    static constexpr std::array<char, kFrozenAlignment> kPadding{};
    const std::vector<FrozenEntry> table = table_of(parts);
    const FrozenHeader header = header_of(table);
    std::vector<std::string_view> pieces{memory_of(header), table_text(table)};
    std::uint64_t end = end_of_table(table.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        pieces.emplace_back(kPadding.data(), table[i].offset - end);
        pieces.push_back(text_of(parts[i].bytes));
        end = table[i].offset + table[i].size;
    }
    use(std::span<const std::string_view>(pieces));
}

FrozenHeader header_at(std::span<const std::byte> bytes) {
    FrozenHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    return header;
}

FrozenEntry entry_at(std::span<const std::byte> bytes, std::uint64_t index) {
    FrozenEntry entry;
    std::memcpy(&entry, bytes.data() + end_of_table(index), sizeof entry);
    return entry;
}

/// The error in a header; nothing for a valid one.
std::optional<std::string> header_problem(const FrozenHeader& header, std::size_t file_size) {
    if (text_of(std::as_bytes(std::span(header.mark))) != kFrozenMark) return "is no frozen scene";
    if (header.byte_order != kByteOrder)
        return "frozen on another kind of machine: freeze the scene again here";
    if (header.format != kFormatVersion || header.software != software_version()) {
        const std::string_view version = text_of(std::as_bytes(std::span(header.software)));
        return "frozen by another version of Lightwalk, " +
               std::string(version.substr(0, version.find('\0'))) +
               ", this is " LIGHTWALK_VERSION ": freeze the scene again";
    }
    if (header.digest != header_digest(header)) return "damaged: the header";
    if (header.file_size > file_size) return "truncated: its end is missing";
    if (header.file_size < file_size) return "damaged: there are bytes after its end";
    if (header.part_count > (file_size - sizeof header) / sizeof(FrozenEntry))
        return "damaged: the header";
    return {};
}

}  // namespace

void write_frozen_file(const std::string& path, std::span<const FrozenPart> parts) {
    in_pieces(parts, [&](std::span<const std::string_view> pieces) {
        write_file_atomically(path, pieces);
    });
}

std::shared_ptr<const MemoryFile> frozen_memory_file(std::span<const FrozenPart> parts) {
    std::shared_ptr<const MemoryFile> file;
    in_pieces(parts, [&](std::span<const std::string_view> pieces) {
        file = std::make_shared<const MemoryFile>(pieces);
    });
    return file;
}

std::string frozen_file_bytes(std::span<const FrozenPart> parts) {
    std::string bytes;
    in_pieces(parts, [&](std::span<const std::string_view> pieces) {
        for (const std::string_view piece : pieces) bytes += piece;
    });
    return bytes;
}

FrozenFile::FrozenFile(const std::shared_ptr<const MappedFile>& file)
    : FrozenFile(file, file->bytes(), file->path()) {}

FrozenFile::FrozenFile(std::shared_ptr<const void> owner, std::span<const std::byte> bytes,
                       std::string name)
    : owner_(std::move(owner)), bytes_(bytes), name_(std::move(name)) {
    assert(reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 == 0);
    if (bytes_.size() < sizeof(FrozenHeader)) {
        throw InputError({name_, 0}, text_of(bytes_).starts_with(kFrozenMark)
                                         ? "truncated: its end is missing"
                                         : "is no frozen scene");
    }
    const FrozenHeader header = header_at(bytes_);
    if (const auto problem = header_problem(header, bytes_.size()))
        throw InputError({name_, 0}, *problem);
    const auto table = bytes_.subspan(sizeof header, header.part_count * sizeof(FrozenEntry));
    if (digest_of_bytes(text_of(table)) != header.table_digest)
        throw InputError({name_, 0}, "damaged: the table of its parts");
    read_table(header.part_count);
}

void FrozenFile::read_table(std::size_t parts) {
    std::uint64_t end = end_of_table(parts);
    for (std::size_t i = 0; i < parts; ++i) {
        const FrozenEntry entry = entry_at(bytes_, i);
        const bool fits = entry.offset % kFrozenAlignment == 0 && entry.offset >= end &&
                          entry.offset <= bytes_.size() &&
                          entry.size <= bytes_.size() - entry.offset;
        if (!fits) throw InputError({name_, 0}, "damaged: the table of its parts");
        end = entry.offset + entry.size;
        const Place place{bytes_.subspan(entry.offset, entry.size), entry.digest};
        if (!parts_.emplace(std::pair(entry.kind, entry.owner), place).second)
            throw InputError({name_, 0}, "damaged: the table of its parts");
    }
}

bool FrozenFile::has(std::uint32_t kind, std::uint32_t owner) const {
    return parts_.contains({kind, owner});
}

std::span<const std::byte> FrozenFile::part(std::uint32_t kind, std::uint32_t owner) const {
    const std::string label = "part " + std::to_string(kind) + " of " + std::to_string(owner);
    const auto found = parts_.find({kind, owner});
    if (found == parts_.end()) throw InputError({name_, 0}, "damaged: " + label + " is missing");
    if (digest_of_bytes(text_of(found->second.bytes)) != found->second.digest)
        throw InputError({name_, 0}, "damaged: " + label);
    return found->second.bytes;
}

std::uint64_t FrozenFile::digest() const {
    return header_at(bytes_).table_digest;
}

std::string resealed(std::string bytes) {
    if (bytes.size() < sizeof(FrozenHeader)) return bytes;
    const auto all = std::as_bytes(std::span<const char>(bytes));
    FrozenHeader header = header_at(all);
    header.file_size = bytes.size();
    const std::uint64_t most = (bytes.size() - sizeof header) / sizeof(FrozenEntry);
    header.part_count = std::min(header.part_count, most);
    for (std::uint64_t i = 0; i < header.part_count; ++i) {
        FrozenEntry entry = entry_at(all, i);
        entry.offset = std::min<std::uint64_t>(entry.offset, bytes.size()) / kFrozenAlignment *
                       kFrozenAlignment;
        entry.size = std::min<std::uint64_t>(entry.size, bytes.size() - entry.offset);
        entry.digest = digest_of_bytes(text_of(all.subspan(entry.offset, entry.size)));
        std::memcpy(bytes.data() + end_of_table(i), &entry, sizeof entry);
    }
    const auto table = all.subspan(sizeof header, header.part_count * sizeof(FrozenEntry));
    header.table_digest = digest_of_bytes(text_of(table));
    std::memcpy(header.mark.data(), kFrozenMark.data(), kFrozenMark.size());
    header.byte_order = kByteOrder;
    header.format = kFormatVersion;
    header.software = software_version();
    header.digest = header_digest(header);
    std::memcpy(bytes.data(), &header, sizeof header);
    return bytes;
}

}  // namespace lightwalk
