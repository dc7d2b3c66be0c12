#pragma once
// Corners that neighbouring triangles have in common.
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
    [[nodiscard]] std::uint32_t find(const double* point, std::span<const double> reals) const;
    /// Note that a point stands at `at` in `reals`.
    void note(const double* point, std::uint32_t at);
    /// Forget all, and give the memory back.
    void clear() { *this = RecentCorners(); }

  private:
    [[nodiscard]] std::size_t place_of(const double* point) const;

    std::vector<std::uint32_t> places_;  ///< by hash, a power of two; empty: nothing is noted
    std::size_t noted_ = 0;
};

}  // namespace lightwalk
