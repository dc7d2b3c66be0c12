#pragma once
// Views of points kept as they were read: three numbers each, side by side or at indices given by a
// list.
#include <cstddef>
#include <iterator>
#include <span>

#include "core/math/vec3.h"
#include "core/model/real_arguments.h"

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
        Iterator(const RealArguments& points, std::size_t i) : points_(points), i_(i) {}
        Vec3 operator*() const { return point_of(points_, i_); }
        Iterator& operator++() {
            ++i_;
            return *this;
        }
        Iterator operator++(int) {
            const Iterator before = *this;
            ++i_;
            return before;
        }
        /// Compares iterators of one list.
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.i_ == b.i_; }

      private:
        RealArguments points_;
        std::size_t i_ = 0;
    };

    PointList() = default;
    /// @param coordinates  x, y and z of each point; an incomplete last point is ignored
    explicit PointList(const RealArguments& coordinates)
        : points_(coordinates), count_(coordinates.size() / 3) {}

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] Vec3 operator[](std::size_t i) const { return point_of(points_, i); }
    [[nodiscard]] Vec3 front() const { return (*this)[0]; }
    [[nodiscard]] Vec3 back() const { return (*this)[count_ - 1]; }
    [[nodiscard]] Iterator begin() const { return {points_, 0}; }
    [[nodiscard]] Iterator end() const { return {points_, count_}; }
    /// The first `count` of its points.
    [[nodiscard]] PointList first(std::size_t count) const {
        PointList less = *this;
        less.count_ = count;
        return less;
    }
    [[nodiscard]] PointList without_last() const { return first(count_ - 1); }

  private:
    static Vec3 point_of(const RealArguments& points, std::size_t i) {
        const double* const at =
            points.data() + (points.corners() == nullptr ? 3 * i : points.corners()[i]);
        return {at[0], at[1], at[2]};
    }

    RealArguments points_;
    std::size_t count_ = 0;
};

}  // namespace lightwalk
