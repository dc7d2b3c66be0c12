#pragma once
// The kinds of parts of a frozen scene, and typed access to them.
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

/// The kind of a part.
enum class FrozenKind : std::uint32_t {
    manifest = 1,  ///< the files that the scene was made from
    answers,       ///< the answers of Resources, by name
    data,
    picture,
    font,
    pixels,  ///< pixels of a picture
    bsdf,
    spectral_picture,
    // Parts of each model; the scene is model number 0.
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
    // Parts of each mesh.
    mesh = 32,
    positions,
    normals,
    us,
    vs,
    triangles,
};

/// Collects the parts of a file to be written.
class FrozenParts {
  public:
    /// Add a part that refers to `values`, which must stay in memory until the file is written.
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

/// A value whose columns refer to bytes of a file, with the owner of these bytes.
template <class T>
struct Mapped {
    std::shared_ptr<const void> bytes;
    T thing;
};

/// The bytes of a part; throws InputError as FrozenFile::part() does.
[[nodiscard]] inline std::span<const std::byte> part_of(const FrozenFile& file, FrozenKind kind,
                                                        std::uint32_t owner = 0) {
    return file.part(static_cast<std::uint32_t>(kind), owner);
}

/// The values of a part, without a copy. Throws InputError as FrozenFile::part() does, and when the
/// length of the part is no multiple of their size.
template <class T>
Column<T> column_of(const FrozenFile& file, FrozenKind kind, std::uint32_t owner) {
    static_assert(alignof(T) <= 8);
    const std::span<const std::byte> bytes = part_of(file, kind, owner);
    if (bytes.size() % sizeof(T) != 0)
        throw InputError({file.name(), 0},
                         "damaged: the length of a column is no multiple of its elements");
    return Column<T>::mapped({reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)});
}

}  // namespace lightwalk
