#pragma once
// Points that stand in memory as they were read: three numbers each, one after the other.
#include <cstddef>
#include <iterator>
#include <span>

#include "core/math/vec3.h"

namespace lightwalk {

/// A view of points; it owns nothing.
class PointList {
  public:
    class Iterator {
      public:
        using iterator_category = std::random_access_iterator_tag;
        using value_type = Vec3;
        using difference_type = std::ptrdiff_t;
        using pointer = const Vec3*;
        using reference = Vec3;

        Iterator() = default;
        explicit Iterator(const double* at) : at_(at) {}
        Vec3 operator*() const { return {at_[0], at_[1], at_[2]}; }
        Iterator& operator++() {
            at_ += 3;
            return *this;
        }
        Iterator operator++(int) {
            const Iterator before = *this;
            at_ += 3;
            return before;
        }
        friend bool operator==(const Iterator&, const Iterator&) = default;

      private:
        const double* at_ = nullptr;
    };

    PointList() = default;
    /// @param coordinates  x, y and z of each point; what is left at the end does not count
    explicit PointList(std::span<const double> coordinates)
        : first_(coordinates.data()), count_(coordinates.size() / 3) {}

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] Vec3 operator[](std::size_t i) const {
        return {first_[3 * i], first_[3 * i + 1], first_[3 * i + 2]};
    }
    [[nodiscard]] Vec3 front() const { return (*this)[0]; }
    [[nodiscard]] Vec3 back() const { return (*this)[count_ - 1]; }
    [[nodiscard]] Iterator begin() const { return Iterator(first_); }
    [[nodiscard]] Iterator end() const { return Iterator(first_ + 3 * count_); }
    [[nodiscard]] const double* data() const { return first_; }
    /// Without its last point.
    [[nodiscard]] PointList without_last() const { return PointList({first_, 3 * (count_ - 1)}); }

  private:
    const double* first_ = nullptr;
    std::size_t count_ = 0;
};

}  // namespace lightwalk
