#pragma once
// Which squares of a picture are traced.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

/// A bit for each tile of a picture: squares of kSide pixels from its lower left corner, row by
/// row. Those at the other edges may be narrower.
class TileMask {
  public:
    static constexpr int kSide = 8;  ///< [pixels]

    /// No tile is set. @param width, height  of the picture, at least 1
    TileMask(int width, int height)
        : columns_((width + kSide - 1) / kSide),
          rows_((height + kSide - 1) / kSide),
          set_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

    [[nodiscard]] std::size_t size() const { return set_.size(); }
    /// The tile of pixel (x, y), y from the bottom.
    [[nodiscard]] std::size_t tile(int x, int y) const {
        return static_cast<std::size_t>(y / kSide) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(x / kSide);
    }
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }

    void set(std::size_t tile) { set_[tile] = 1; }
    [[nodiscard]] bool operator[](std::size_t tile) const { return set_[tile] != 0; }
    /// Whether a pixel of this rectangle, which lies inside the picture, is in a tile that is set.
    [[nodiscard]] bool meets(const PixelRectangle& pixels) const {
        if (pixels.x0 >= pixels.x1 || pixels.y0 >= pixels.y1) return false;
        for (int y = pixels.y0 / kSide; y <= (pixels.y1 - 1) / kSide; ++y)
            for (int x = pixels.x0 / kSide; x <= (pixels.x1 - 1) / kSide; ++x)
                if ((*this)[tile(x * kSide, y * kSide)]) return true;
        return false;
    }

    /// One byte a tile, 0 or 1, to be sent; set_bytes() takes no other number of them.
    [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return set_; }
    [[nodiscard]] bool set_bytes(std::vector<std::uint8_t> bytes) {
        if (bytes.size() != set_.size()) return false;
        set_ = std::move(bytes);
        return true;
    }

  private:
    int columns_, rows_;
    std::vector<std::uint8_t> set_;
};

}  // namespace lightwalk
