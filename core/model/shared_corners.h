#pragma once
// Corners that neighbouring triangles have in common.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwalk {

/// Finds points, by their bits, among those that were noted lately. Forgets a point when another
/// takes its place: a surface that was cut into triangles meets its corners again soon.
class RecentCorners {
  public:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// Where in `reals` the point was noted; kNone: it is not known (any more).
    /// @param point  three numbers
    /// @param reals  what it was noted in, which may have grown since
    [[nodiscard]] std::uint32_t find(const double* point, std::span<const double> reals);
    /// Note that a point stands at `at` in `reals`.
    void note(const double* point, std::uint32_t at);
    /// Forget all, and give the memory back.
    void clear() { *this = RecentCorners(); }

  private:
    using Bits = std::array<std::uint64_t, 3>;  ///< of a point's numbers

    /// A point that was found or noted last: most corners are those of the triangle before, and the
    /// table lies too far from the processor to be asked for each.
    struct Last {
        Bits bits{};
        std::uint32_t at = kNone;
    };

    [[nodiscard]] std::size_t place_of(const Bits& bits) const;
    void remember(const Bits& bits, std::uint32_t at);

    std::vector<std::uint32_t> places_;  ///< by hash, a power of two; empty: nothing is noted
    std::size_t noted_ = 0;
    std::array<Last, 8> last_;
    std::size_t next_last_ = 0;  ///< of `last_` to be written
};

}  // namespace lightwalk
