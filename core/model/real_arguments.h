#pragma once
// Real arguments of a surface, however a list keeps them.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwalk {

/// A view of numbers: side by side, or in threes where they are the corners of a triangle that
/// shares them with others. It owns nothing.
class RealArguments {
  public:
    RealArguments() = default;
    RealArguments(std::span<const double> reals)  // NOLINT: such a span is one
        : first_(reals.data()), size_(reals.size()) {}
    RealArguments(const std::vector<double>& reals)  // NOLINT
        : RealArguments(std::span(reals)) {}
    /// @param reals    that the corners are places in
    /// @param corners  of each three numbers
    RealArguments(const double* reals, std::span<const std::uint32_t> corners)
        : first_(reals), corners_(corners.data()), size_(3 * corners.size()) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] double operator[](std::size_t i) const {
        return corners_ == nullptr ? first_[i] : first_[corners_[i / 3] + i % 3];
    }
    /// The numbers, or what the corners are places in.
    [[nodiscard]] const double* data() const { return first_; }
    /// Null: the numbers are side by side.
    [[nodiscard]] const std::uint32_t* corners() const { return corners_; }

  private:
    const double* first_ = nullptr;
    const std::uint32_t* corners_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace lightwalk
