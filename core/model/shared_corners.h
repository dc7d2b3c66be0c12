#pragma once
// Detection of corners that neighbouring triangles share.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwalk {

/// A hash table, by exact bits, of the points that were noted last. A new point may overwrite an
/// old one (a cache): triangles that share a corner usually follow each other closely.
class RecentCorners {
  public:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// The index in `reals` at which the point was noted; kNone where it is unknown or forgotten.
    /// @param point  three numbers
    /// @param reals  the array that it was noted in, which may have grown since
    [[nodiscard]] std::uint32_t find(const double* point, std::span<const double> reals);
    /// Note that a point stands at `at` in `reals`.
    void note(const double* point, std::uint32_t at);
    /// Forget all points and free the memory.
    void clear() { *this = RecentCorners(); }

  private:
    using Bits = std::array<std::uint64_t, 3>;  ///< bits of a point's three numbers

    /// One of the points found or noted last. Most corners are those of the preceding triangle;
    /// looking here first avoids a cache miss in the table.
    struct Last {
        Bits bits{};
        std::uint32_t at = kNone;
    };

    [[nodiscard]] std::size_t place_of(const Bits& bits) const;
    void remember(const Bits& bits, std::uint32_t at);

    std::vector<std::uint32_t>
        places_;  ///< indices by hash; the size is a power of two, or 0 while nothing is noted
    std::size_t noted_ = 0;
    std::array<Last, 8> last_;
    std::size_t next_last_ = 0;  ///< index of the element of `last_` to be overwritten next
};

}  // namespace lightwalk
