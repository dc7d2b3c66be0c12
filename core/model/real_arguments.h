#pragma once
// Views of the real arguments of a surface, stored directly or by shared corners.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwalk {

/// A view of numbers: either contiguous, or given by the index of each corner (three numbers) of a
/// triangle that shares corners with others.
class RealArguments {
  public:
    RealArguments() = default;
    RealArguments(std::span<const double> reals)  // NOLINT: such a span is one
        : first_(reals.data()), size_(reals.size()) {}
    RealArguments(const std::vector<double>& reals)  // NOLINT
        : RealArguments(std::span(reals)) {}
    /// @param reals    the array that `corners` index
    /// @param corners  index of the first of the three numbers of each corner
    RealArguments(const double* reals, std::span<const std::uint32_t> corners)
        : first_(reals), corners_(corners.data()), size_(3 * corners.size()) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] double operator[](std::size_t i) const {
        return corners_ == nullptr ? first_[i] : first_[corners_[i / 3] + i % 3];
    }
    /// The contiguous numbers, or the array that corners() index.
    [[nodiscard]] const double* data() const { return first_; }
    /// Indices of the corners; null where the numbers are contiguous.
    [[nodiscard]] const std::uint32_t* corners() const { return corners_; }

  private:
    const double* first_ = nullptr;
    const std::uint32_t* corners_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace lightwalk
