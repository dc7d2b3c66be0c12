#pragma once
// What the parts of a frozen scene are called.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/model/column.h"
#include "io/scene/frozen_file.h"

namespace lightwalk {

/// What a part of a frozen scene holds.
enum class FrozenKind : std::uint32_t {
    manifest = 1,
    answers,  ///< what the library answered, by name
    data,
    picture,
    font,
    pixels,  ///< of a picture
    // Of each model; the scene is number 0.
    model = 16,
    records,
    reals,
    text,
    strings,
    rows,
    spheres,
    cones,
    rings,
    sources,
    corners,
    // Of each mesh.
    mesh = 32,
    positions,
    normals,
    us,
    vs,
    triangles,
};

/// The parts of a file that is to be written.
class FrozenParts {
  public:
    /// The values must stay where they are until the file is written.
    template <class T>
    void add(FrozenKind kind, std::uint32_t owner, std::span<const T> values) {
        parts_.push_back({static_cast<std::uint32_t>(kind), owner, std::as_bytes(values)});
    }
    void add(FrozenKind kind, std::uint32_t owner, std::string packed) {
        packed_.push_back(std::move(packed));
        add(kind, owner, std::span<const char>(packed_.back()));
    }
    [[nodiscard]] std::span<const FrozenPart> parts() const { return parts_; }

  private:
    std::vector<FrozenPart> parts_;
    std::deque<std::string> packed_;
};

/// A thing, and what keeps the bytes that its columns show.
template <class T>
struct Mapped {
    std::shared_ptr<const void> bytes;
    T thing;
};

/// The bytes of a part; throws InputError as FrozenFile::part.
[[nodiscard]] inline std::span<const std::byte> part_of(const FrozenFile& file, FrozenKind kind,
                                                        std::uint32_t owner = 0) {
    return file.part(static_cast<std::uint32_t>(kind), owner);
}

/// The values of a part, where they lie; throws InputError also for a broken number of them.
template <class T>
Column<T> column_of(const FrozenFile& file, FrozenKind kind, std::uint32_t owner) {
    static_assert(alignof(T) <= 8);
    const std::span<const std::byte> bytes = part_of(file, kind, owner);
    if (bytes.size() % sizeof(T) != 0)
        throw InputError({file.name(), 0}, "damaged: a column of broken length");
    return Column<T>::mapped({reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)});
}

}  // namespace lightwalk
