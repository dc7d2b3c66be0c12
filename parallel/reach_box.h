#pragma once
// Lock-free bounding boxes of the regions in which the records of a cube of the ambient cache are
// usable, in eight bytes each.
#include <algorithm>
#include <atomic>
#include <cstdint>

#include "core/ambient/ambient_cache.h"

namespace lightwalk {

/// Quantized coordinates of a place in a cube that is grown by its edge length on either side: 0 to
/// 127, clamped. Monotone: a place between two others never lies outside their steps.
class ReachGrid {
  public:
    explicit ReachGrid(const CachePath& cube)
        : least_{cube.corner.x - cube.edge, cube.corner.y - cube.edge, cube.corner.z - cube.edge},
          scale_(kMost / (3 * cube.edge)) {}
    [[nodiscard]] std::uint64_t step(std::size_t axis, double place) const {
        return step_of((place - least_[axis]) * scale_);
    }

  private:
    static constexpr double kMost = 127;
    static std::uint64_t step_of(double x) {
        return !(x > 0) ? 0 : x < kMost ? static_cast<std::uint64_t>(x) : 127;
    }
    Vec3 least_;
    double scale_;
};

/// A box on the grid of a cube: three least steps and three greatest, a byte each, which leaves a
/// bit for the borrow when all six are compared by one subtraction.
class ReachBox {
  public:
    /// The steps of a place, stored twice, in the form that `holds` compares.
    static constexpr std::uint64_t place(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
        return (x | y << 8 | z << 16) * 0x1000001;
    }
    [[nodiscard]] bool holds(std::uint64_t place) const {
        const std::uint64_t box = box_.load(std::memory_order_relaxed);
        const std::uint64_t greater = (place & kLow) | (box & kHigh),
                            lesser = (box & kLow) | (place & kHigh);
        return (((greater | kBorrow) - lesser) & kBorrow) == kBorrow;
    }
    /// Enlarge the box to include the one from `low` to `high`, in world coordinates.
    void grow(const ReachGrid& grid, const Vec3& low, const Vec3& high) {
        std::uint64_t old = box_.load(std::memory_order_relaxed), grown = 0;
        do {
            grown = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const unsigned at = 8 * static_cast<unsigned>(k);
                grown |= std::min(old >> at & 0x7f, grid.step(k, low[k])) << at;
                grown |= std::max(old >> (at + 24) & 0x7f, grid.step(k, high[k])) << (at + 24);
            }
        } while (grown != old &&
                 !box_.compare_exchange_weak(old, grown, std::memory_order_relaxed));
    }

  private:
    static constexpr std::uint64_t kLow = 0x7f7f7f, kHigh = kLow << 24, kBorrow = 0x808080808080;
    std::atomic<std::uint64_t> box_{kLow};  ///< holds nothing
};

}  // namespace lightwalk
