#include "parallel/sub_images.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lightwalk {

SubImages::SubImages(const PixelRectangle& area, std::size_t count) : area_(area), count_(count) {
    // Columns of about equal shape; the last ones may hold one rectangle more.
    const double aspect =
        static_cast<double>(std::max(1, area.width())) / std::max(1, area.height());
    const auto n = static_cast<double>(std::max<std::size_t>(1, count));
    columns_ = static_cast<std::size_t>(std::clamp(std::round(std::sqrt(n * aspect)), 1.0, n));
}

PixelRectangle SubImages::part(std::size_t column, std::size_t row) const {
    const auto cut = [](int from, int size, std::size_t i, std::size_t pieces) {
        return from +
               static_cast<int>(static_cast<std::int64_t>(size) * static_cast<std::int64_t>(i) /
                                static_cast<std::int64_t>(pieces));
    };
    // A column is as wide as its share of the rectangles.
    const std::size_t first = first_of(column), rows = first_of(column + 1) - first;
    return {cut(area_.x0, area_.width(), first, count_), cut(area_.y0, area_.height(), row, rows),
            cut(area_.x0, area_.width(), first + rows, count_),
            cut(area_.y0, area_.height(), row + 1, rows)};
}

PixelRectangle SubImages::operator[](std::size_t i) const {
    const std::size_t column = ((i + 1) * columns_ - 1) / count_;
    return part(column, i - first_of(column));
}

std::vector<std::size_t> SubImages::overlapping(const PixelRectangle& block) const {
    std::vector<std::size_t> found;
    // The first column, or row of a column, that ends beyond a place: their ends never decrease.
    const auto first_beyond = [](std::size_t count, int place, auto end_of) {
        std::size_t low = 0, high = count;
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            if (end_of(middle) > place)
                high = middle;
            else
                low = middle + 1;
        }
        return low;
    };
    const std::size_t left =
        first_beyond(columns_, block.x0, [&](std::size_t c) { return part(c, 0).x1; });
    for (std::size_t c = left; c < columns_ && part(c, 0).x0 < block.x1; ++c) {
        const std::size_t first = first_of(c), rows = first_of(c + 1) - first;
        const std::size_t low =
            first_beyond(rows, block.y0, [&](std::size_t r) { return part(c, r).y1; });
        for (std::size_t r = low; r < rows && part(c, r).y0 < block.y1; ++r) {
            if (!part(c, r).empty()) found.push_back(first + r);
        }
    }
    return found;
}

}  // namespace lightwalk
