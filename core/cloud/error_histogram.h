#pragma once
// How errors are distributed, of any number of pixels.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lightwalk {

/// Values counted by size, so that any number of them takes the same room.
class ErrorHistogram {
  public:
    void add(std::span<const float> values);
    [[nodiscard]] std::size_t count() const { return count_; }
    /// The value that a share (0 ... 1) of the values lies below, within 2 %; 0 where there are
    /// none. Values below 1e-5 count as 0, those above 1e5 as 1e5.
    [[nodiscard]] double quantile(double share) const;

  private:
    static constexpr std::size_t kBins = 1200;
    std::array<std::uint64_t, kBins + 1> bins_{};  ///< 120 a decade; the first: next to nothing
    std::size_t count_ = 0;
};

}  // namespace lightwalk
