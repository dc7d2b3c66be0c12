#pragma once
// The rectangles of a picture that its workers own.
#include <cstddef>
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

/// `count` rectangles side by side, as square as they come; some are empty when there are fewer
/// pixels than workers. None is kept: with as many workers as a large machine has cores, a list of
/// all would be too long to be walked each block.
class SubImages {
  public:
    SubImages() = default;
    SubImages(const PixelRectangle& area, std::size_t count);
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] PixelRectangle operator[](std::size_t i) const;
    /// Indices of all that share pixels with `block`, smallest first.
    [[nodiscard]] std::vector<std::size_t> overlapping(const PixelRectangle& block) const;

  private:
    [[nodiscard]] std::size_t first_of(std::size_t column) const {
        return column * count_ / columns_;
    }
    [[nodiscard]] PixelRectangle part(std::size_t column, std::size_t row) const;

    PixelRectangle area_;
    std::size_t count_ = 0, columns_ = 1;
};

}  // namespace lightwalk
